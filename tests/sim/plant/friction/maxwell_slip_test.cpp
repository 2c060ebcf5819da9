// Maxwell-slip elements: presliding with nonlocal memory.
#include "sim/plant/friction/maxwell_slip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sim/machine_file.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction::sim {
namespace {

constexpr double mass = 225.0, step = 15.625e-6;
const MaxwellSlipParameters elements{{2e7, 8e6, 2e6, 5e5}, {20.0, 30.0, 30.0, 25.0}, 0.0};

// The contact force (N) after the carriage was moved by `distance` (m): what slows a free mass in that step.
double move(MaxwellSlip<>& model, double distance, int steps = 100) {
  double force = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double v = distance / (steps * step);
    force = (v - model.advance(v, 0.0)) * mass / step;
  }
  return force;
}

// The virgin curve: each spring until it slips.
double virgin(double x) {
  double force = 0.0;
  for (std::size_t i = 0; i < elements.level.size(); ++i)
    force += std::clamp(elements.stiffness[i] * x, -elements.level[i], elements.level[i]);
  return force;
}

// Speeds of 1 cm/s are rounded by 1e-18 m/s: times m / h, 2e-11 N; steps of a sum add up.
constexpr double tolerance = 1e-8;

TEST(MaxwellSlip, FirstLoadingFollowsTheSumOfItsSprings) {
  for (const double x : {0.1e-6, 0.9e-6, 3e-6, 10e-6, 40e-6}) {
    MaxwellSlip model(elements, {mass, step});
    EXPECT_NEAR(move(model, x), virgin(x), tolerance) << x;
    MaxwellSlip back(elements, {mass, step});
    EXPECT_NEAR(move(back, -x), -virgin(x), tolerance) << x;
  }
}

TEST(MaxwellSlip, FarSlidingCarriesTheSumOfTheLevels) {
  MaxwellSlip model(elements, {mass, step});
  EXPECT_NEAR(move(model, 1e-3), 105.0, tolerance);
  EXPECT_NEAR(move(model, -1e-3), -105.0, tolerance);
}

TEST(MaxwellSlip, AfterAReversalTheBranchIsTheVirginCurveTwiceAsLarge) {
  // Masing's rule: F = F_r - 2 f((x_r - x) / 2).
  for (const double turn : {2e-6, 8e-6, 100e-6})
    for (const double back : {0.5e-6, 2e-6, 7e-6, 30e-6}) {
      if (back > 2.0 * turn) continue;
      MaxwellSlip model(elements, {mass, step});
      const double at_turn = move(model, turn);
      EXPECT_NEAR(move(model, -back), at_turn - 2.0 * virgin(0.5 * back), tolerance) << turn << ", " << back;
    }
}

TEST(MaxwellSlip, AnInnerLoopClosesAndIsForgotten) {
  MaxwellSlip direct(elements, {mass, step}), looped(elements, {mass, step});
  const double at_turn = move(direct, 8e-6);
  move(looped, 8e-6);
  move(looped, -3e-6);
  move(looped, 1e-6);
  move(looped, -1e-6);
  EXPECT_NEAR(move(looped, 3e-6), at_turn, tolerance) << "back at the point of return";
  EXPECT_NEAR(move(looped, 5e-6), move(direct, 5e-6), tolerance) << "and on as if the loop had not been";
}

RC_GTEST_PROP(MaxwellSlip, NoElementExceedsItsLevelHoweverItIsMoved, ()) {
  MaxwellSlip model(elements, {mass, step});
  for (int i = 0; i < 100; ++i) {
    const double force = move(model, 1e-9 * static_cast<double>(test::drawn_between(-50000, 50000)), 1);
    RC_ASSERT(std::abs(force) <= 105.0 + tolerance);
  }
}

TEST(MaxwellSlip, AClosedCycleDissipates) {
  MaxwellSlip model(elements, {mass, step});
  move(model, 10e-6);
  double work = 0.0;
  for (const double direction : {-1.0, 1.0})
    for (int i = 0; i < 2000; ++i) work += direction * 10e-9 * move(model, direction * 10e-9, 1);
  // The loop between +-10 um by Masing's rule: 8 times the virgin curve's area less 4 x_r F_r.
  double area = 0.0;
  for (int i = 0; i < 100000; ++i) area += virgin((i + 0.5) * 1e-10) * 1e-10;
  const double expected = 8.0 * (area - 0.5 * 10e-6 * virgin(10e-6));
  // The sum takes each force at the end of its 10 nm: 20 um * 2 * 10 nm * stiffness / 2 of the branches' starts.
  EXPECT_NEAR(work, expected, 0.02 * expected);
}

TEST(MaxwellSlip, ViscousFrictionIsOnTop) {
  auto p = elements;
  p.viscous = 500.0;
  MaxwellSlip model(p, {mass, step});
  for (int i = 0; i < 1000; ++i) model.advance(0.1, 0.0);
  EXPECT_NEAR(model.advance(0.1, 105.0 + 50.0), 0.1, 1e-15);
}

// The same elements with levels that rise by 60 N in all, to 165 N.
MaxwellSlipParameters rising() {
  auto p = elements;
  p.rise = 60.0;
  p.rise_velocity = 0.02;
  return p;
}

// Slides for a distance (m) at a speed (m/s, its sign apart), in steps of the plant.
double slide(MaxwellSlip<>& model, double velocity, double distance) {
  double force = 0.0;
  for (double x = 0.0; x < distance; x += std::abs(velocity) * step) force = model.move_contact(velocity);
  return force;
}

TEST(RateAndState, SteadySlidingFollowsTheCurve) {
  for (const double v : {1e-3, 0.02, 0.4}) {
    const double expected = 105.0 + 60.0 * (1.0 - std::exp(-v / 0.02));
    MaxwellSlip model(rising(), {mass, step});
    // 20 times the longest break-away displacement, 50 um; the series of the relaxation is exact to 2e-8.
    EXPECT_NEAR(slide(model, v, 2e-3), expected, 1e-5) << v;
    EXPECT_NEAR(slide(model, -v, 2e-3), -expected, 1e-5) << v;
  }
}

TEST(RateAndState, AStopKeepsTheFrictionOfTheSpeedBefore) {
  MaxwellSlip model(rising(), {mass, step});
  const double sliding = slide(model, 0.4, 2e-3);
  double held = 0.0;
  for (int i = 0; i < 64000; ++i) held = model.move_contact(0.0);  // a second
  EXPECT_NEAR(held, sliding, tolerance);
  // Going on slowly forgets it over the longest break-away displacement.
  EXPECT_GT(slide(model, 1e-4, 0.5e-6), 0.9 * sliding);
  EXPECT_NEAR(slide(model, 1e-4, 1e-3), 105.0 + 60.0 * (1.0 - std::exp(-1e-4 / 0.02)), 0.01);
}

TEST(RateAndState, CreepingIsPlainMaxwellSlip) {
  // At 1 um/s the rise is 3 mN.
  for (const double turn : {2e-6, 8e-6}) {
    MaxwellSlip plain(elements, {mass, step}), with_rise(rising(), {mass, step});
    EXPECT_NEAR(slide(with_rise, 1e-6, turn), slide(plain, 1e-6, turn), 0.005);
    EXPECT_NEAR(slide(with_rise, -1e-6, turn), slide(plain, -1e-6, turn), 0.005);
  }
}

RC_GTEST_PROP(RateAndState, TakesOutNoMoreWorkThanWasStored, ()) {
  // Whatever the motion, work done on the contact is at least the energy its springs hold, so never negative.
  MaxwellSlip model(rising(), {mass, step});
  double work = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double v = 1e-4 * static_cast<double>(test::drawn_between(-3000, 3000));
    const int steps = static_cast<int>(test::drawn_between(1, 40));
    for (int j = 0; j < steps; ++j) work += model.move_contact(v) * v * step;
    RC_ASSERT(work >= -1e-12);
  }
}

RC_GTEST_PROP(RateAndState, DoesNotDriftUnderSmallVibration, ()) {
  // Minor loops close: after whole periods of vibration the contact is where it was. A rise that these speeds of at
  // most 1.3 mm/s hardly wake (60 N * 1.3e-3 / 10) leaves no more than its own 8 mN.
  auto p = rising();
  p.rise_velocity = 10.0;
  MaxwellSlip model(p, {mass, step});
  slide(model, 1e-3, 1e-3);
  const double amplitude = 1e-8 * static_cast<double>(test::drawn_between(1, 100));
  const auto period = [&] {
    double force = 0.0;
    for (const double direction : {-1.0, 1.0})
      for (int i = 0; i < 50; ++i) force = model.move_contact(direction * amplitude / (50 * step));
    return force;
  };
  const double first = period();
  double last = first;
  for (int i = 0; i < 20; ++i) last = period();
  RC_ASSERT(std::abs(last - first) < 0.01);
}

TEST(MaxwellSlip, RefusesListsOfDifferentLength) {
  const auto values = values_of<MaxwellSlip<>>({{1e6, 2e6}, {10.0}, 0.0});
  EXPECT_THROW(machine::check_values(*vocabulary().find_friction_model("maxwell_slip"), values), machine::ValueError);
}

}  // namespace
}  // namespace stiction::sim
