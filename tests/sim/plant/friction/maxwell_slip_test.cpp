// Maxwell-slip elements: presliding with nonlocal memory.
#include "sim/plant/friction/maxwell_slip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/firmware/number/exact.hpp"

namespace stiction::sim {
namespace {

constexpr double mass = 225.0, step = 15.625e-6;
const MaxwellSlip::Parameters elements{{2e7, 8e6, 2e6, 5e5}, {20.0, 30.0, 30.0, 25.0}, 0.0};

// The contact force (N) after the carriage was moved by `distance` (m): what slows a free mass in that step.
double move(MaxwellSlip& model, double distance, int steps = 100) {
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

TEST(MaxwellSlip, RefusesListsOfDifferentLength) {
  EXPECT_THROW(MaxwellSlip({{1e6, 2e6}, {10.0}, 0.0}, {mass, step}), std::invalid_argument);
}

}  // namespace
}  // namespace stiction::sim
