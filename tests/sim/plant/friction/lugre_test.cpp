// LuGre (Mendricky 2006, 4.2-4.7, 4.15): the properties that the continuous model is chosen for must survive the steps.
#include "sim/plant/friction/lugre.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/firmware/number/exact.hpp"

namespace stiction::sim {
namespace {

// Tab 4.3: m 400 kg, k_s 4e7 N/m, b_s 0.2 sqrt(1.6e10) N s/m, mu_v 200 N s/m, F_C 400 N, F_Ts 600 N, v_s 1 mm/s.
constexpr double mass = 400.0, stiffness = 4e7, coulomb = 400.0, static_level = 600.0, stribeck = 1e-3;
constexpr LuGreParameters feed_axis{coulomb, static_level / coulomb, 200.0, stribeck, stiffness, 0.1};
constexpr double step = 15.625e-6;

double limit_of(const LuGreParameters& p, double v) {
  const double level = p.coulomb + p.coulomb * (p.static_ratio - 1.0) * std::exp(-std::pow(v / p.stribeck_velocity, 2));
  return level / p.stiffness;
}

double power_of_ten(double low, double high) {
  return std::pow(10.0,
                  1e-3 * static_cast<double>(test::drawn_between(std::lround(1e3 * low), std::lround(1e3 * high))));
}
double drawn_speed() { return power_of_ten(-9, 1) * static_cast<double>(2 * test::drawn_between(0, 1) - 1); }

LuGreParameters drawn_parameters() {
  return {power_of_ten(0, 3),
          1.0 + 0.5 * static_cast<double>(test::drawn_between(0, 4)),
          0.0,
          power_of_ten(-5, -1),
          power_of_ten(4, 9),
          0.1};
}

RC_GTEST_PROP(LuGre, DeflectionNeverExceedsItsLargestLimitAtAnySpeedAndStep, ()) {
  const auto p = drawn_parameters();
  LuGre model(p, {mass, power_of_ten(-7, -2)});
  const double largest = p.coulomb * p.static_ratio / p.stiffness;
  for (int i = 0; i < 100; ++i) {
    model.move_contact(drawn_speed());
    // Each step goes a share of the way to g, which stays between 0 and 1 however it is approximated.
    RC_ASSERT(std::abs(model.deflection()) <= largest * (1.0 + 1e-14));
  }
}

// z between two states under a held speed: z(t) = z_s + (z_0 - z_s) exp(-|v| t / g), z_s = g sgn v; its integral over
// the step in closed form.
double integral_of_deflection(double z_0, double v, double g, double h) {
  const double z_s = std::copysign(g, v);
  const double rate = std::abs(v) / g;
  return z_s * h - (z_0 - z_s) * std::expm1(-rate * h) / rate;
}

RC_GTEST_PROP(LuGre, IsDissipativeFromSpeedToDeflection, ()) {
  // k_s times the integral of v z is at least the growth of the stored energy k_s z^2 / 2, in every step.
  const auto p = drawn_parameters();
  const double h = power_of_ten(-7, -3);
  LuGre model(p, {mass, h});
  for (int i = 0; i < 100; ++i) {
    const double v = drawn_speed();
    const double before = model.deflection();
    const double supplied = p.stiffness * v * integral_of_deflection(before, v, limit_of(p, v), h);
    model.move_contact(v);
    const double after = model.deflection();
    const double stored = 0.5 * p.stiffness * (after * after - before * before);
    // The share of the way to g is within 6e-8; energies are up to k_s g^2, supplies up to k_s g |v| h.
    const double g = p.coulomb * p.static_ratio / p.stiffness;
    const double rounding =
        1.2e-7 * p.stiffness * g * std::min(2.0 * g, std::abs(v) * h) + 1e-13 * p.stiffness * g * (g + std::abs(v) * h);
    RC_ASSERT(supplied >= stored - rounding);
  }
}

RC_GTEST_PROP(LuGre, AHeldSpeedGivesTheSameDeflectionInOneStepOrInMany, ()) {
  const auto p = drawn_parameters();
  const double v = drawn_speed();
  const double h = power_of_ten(-6, -3);
  LuGre one(p, {mass, h}), many(p, {mass, h / 16.0});
  one.move_contact(0.1 * v);
  for (int i = 0; i < 16; ++i) many.move_contact(0.1 * v);
  one.move_contact(-v);
  for (int i = 0; i < 16; ++i) many.move_contact(-v);
  // The exponential's series is within 6e-8 of each change; the changes of both sides are at most 2 g each.
  RC_ASSERT(std::abs(one.deflection() - many.deflection()) <= 4e-7 * p.coulomb * p.static_ratio / p.stiffness);
}

TEST(LuGre, InSteadySlidingTheContactCarriesTheStribeckCurve) {
  for (const double v : {1e-5, 3e-4, 1e-3, 2e-3, 0.1, -1e-3, -0.1}) {
    LuGre model(feed_axis, {mass, step});
    double contact = 0.0;
    for (double travelled = 0.0; travelled < 40.0 * static_level / stiffness; travelled += std::abs(v) * step)
      contact = model.move_contact(v);
    const double expected = coulomb + (static_level - coulomb) * std::exp(-v * v / (stribeck * stribeck));  // (4.7)
    EXPECT_NEAR(contact, std::copysign(expected, v), 1e-9 * expected) << v;
  }
}

TEST(LuGre, InPreslidingItIsASpringOfTheContactStiffness) {
  LuGre model(feed_axis, {mass, step});
  // 10 nm in 1000 steps; g is 15 um: the creep is half of 10 nm / 15 um, 3.3e-4.
  const double v = 10e-9 / (1000 * step);
  for (int i = 0; i < 1000; ++i) model.move_contact(v);
  EXPECT_NEAR(model.deflection() * stiffness, stiffness * 10e-9, 3.4e-4 * stiffness * 10e-9);
  for (int i = 0; i < 1000; ++i) model.move_contact(-v);
  EXPECT_NEAR(model.deflection(), 0.0, 2 * 3.4e-4 * 10e-9) << "and gives it back";
}

TEST(LuGre, ContactDampingIsTwiceTheRatioTimesTheRootOfStiffnessAndMass) {
  // (4.15): 0.2 sqrt(4e7 * 400) = 25298 N s/m. The first step from rest: k z + b z', z' = v but for the creep of
  // v h / (2 g) = 5e-10.
  LuGre model(feed_axis, {mass, step});
  const double v = 1e-9;
  const double contact = model.move_contact(v);
  EXPECT_NEAR((contact - stiffness * v * step) / v, 0.2 * std::sqrt(1.6e10), 1e-6 * 25298.0);
}

TEST(LuGre, AtStandstillTheDeflectionIsKept) {
  LuGre model(feed_axis, {mass, step});
  for (int i = 0; i < 100; ++i) model.move_contact(1e-3);
  const double z = model.deflection();
  ASSERT_GT(z, 1e-6);
  EXPECT_EQ(model.move_contact(0.0), stiffness * z) << "no damping force without motion";
  EXPECT_EQ(model.deflection(), z);
}

TEST(LuGre, HoldsAForceBelowItsStaticLevelAndSlidesAboveIt) {
  for (const double force : {540.0, 620.0}) {
    LuGre model(feed_axis, {mass, step});
    double v = 0.0, x = 0.0;
    for (int i = 0; i < 128000; ++i) {  // two seconds, the force rises within one: no inertia of the break-away
      const double next = model.advance(v, std::min(1.0, i / 64000.0) * force);
      x += 0.5 * step * (v + next);
      v = next;
    }
    if (force < 600.0) {
      // Presliding: -g ln(1 - z/g) for a slow ramp, z/g = 0.9: 35 um, and a creep that ends as v falls to zero.
      EXPECT_LT(x, 60e-6);
      EXPECT_LT(std::abs(v), 1e-6);
    } else {
      EXPECT_GT(v, 0.1);
    }
  }
}

TEST(LuGre, FrictionIsLowerForFallingThanForRisingSpeed) {
  // Frictional lag (4.4.3): v = 2.5 + 2.4 sin(w t) mm/s at 10 rad/s; docs/prototype_figures.md, 4: the loop is 66.7 N
  // wide. Both branches are compared at equal speed, the largest difference.
  LuGre model(feed_axis, {mass, step});
  constexpr double omega = 10.0;
  const auto speed = [&](double t) { return 1e-3 * (2.5 + 2.4 * std::sin(omega * t)); };
  const int period = static_cast<int>(std::lround(2.0 * 3.141592653589793 / omega / step));
  std::vector<double> force(static_cast<std::size_t>(period));
  for (int i = 0; i < 3 * period; ++i) {
    const double v = speed(i * step);
    force[static_cast<std::size_t>(i % period)] = model.move_contact(v) + 200.0 * v;
  }
  double widest = 0.0;
  for (int i = 1; i < period / 4; ++i) {
    // sin is mirrored at a quarter period: rising at i, falling at period / 2 - i.
    const double rising = force[static_cast<std::size_t>(i)], falling = force[static_cast<std::size_t>(period / 2 - i)];
    widest = std::max(widest, rising - falling);
    const double low_rising = force[static_cast<std::size_t>(period - i)];
    const double low_falling = force[static_cast<std::size_t>(period / 2 + i)];
    widest = std::max(widest, low_rising - low_falling);
  }
  EXPECT_NEAR(widest, 66.7, 0.2);
}

TEST(OneMinusExp, IsWithinItsStatedErrorOverItsWholeRange) {
  // The header states 2e-8.
  for (double a = 1e-12; a < 1e3; a *= 1.003)
    ASSERT_NEAR(one_minus_exp(a) / static_cast<double>(-expm1l(-static_cast<long double>(a))), 1.0, 2e-8) << a;
  EXPECT_EQ(one_minus_exp(0.0), 0.0);
  EXPECT_EQ(one_minus_exp(std::numeric_limits<double>::infinity()), 1.0);
}

TEST(OneMinusExp, OfManyShortStepsIsThatOfTheirSum) {
  // 1000 steps of 0.01: the product of their remainders is exp(-10), each within 2e-8 * 0.01.
  double rest = 1.0;
  for (int i = 0; i < 1000; ++i) rest *= 1.0 - one_minus_exp(0.01);
  EXPECT_NEAR(rest / std::exp(-10.0), 1.0, 1000 * 2e-8 * 0.01 + 1e-12);
}

}  // namespace
}  // namespace stiction::sim
