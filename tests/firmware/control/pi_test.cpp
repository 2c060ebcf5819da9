// The PI controller against its law in exact arithmetic, its step response against the closed form of
// k (1 + 1 / (T_N s)), and its anti-windup.
#include "stiction/control/pi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/drive/axis.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/firmware/number/exact.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::Int128;
using Fixed = VelocityPi<S>;
using Real = VelocityPi<machine::DoubleSignals>;

constexpr double tick = 62.5e-6;

template <class PiOf, class P, class I, class T>
typename PiOf::Config config(double gain, double integral_time) {
  return {machine::to_signal<P>(gain).value(), machine::to_signal<I>(gain * tick / integral_time).value(),
          machine::to_signal<T>(tick / integral_time).value()};
}
Fixed::Config fixed_config(double gain, double time) {
  return config<Fixed, S::VelocityGain, S::VelocityIntegralGain, S::VelocityTracking>(gain, time);
}
Real::Config real_config(double gain, double time) {
  return config<Real, machine::Real, machine::Real, machine::Real>(gain, time);
}

// 600 A s/m over 5 ms: k T / T_N = 7.5 A s/m, an exact number of the format.
RC_GTEST_PROP(Pi, FixedPointIsTheExactSumRoundedOnce, ()) {
  constexpr int proportional_bits = S::VelocityGain::fraction_bits + S::Velocity::fraction_bits;
  constexpr int integral_bits = S::VelocityIntegralGain::fraction_bits + S::Velocity::fraction_bits;
  static_assert(S::VelocityIntegral::fraction_bits == integral_bits, "the integrator keeps all bits of the product");
  constexpr int bits = std::max(proportional_bits, integral_bits);
  const auto c = fixed_config(600.0, 5e-3);
  Fixed::State state;
  SaturationCounter saturations;
  Int128 sum = 0;  // of the errors
  for (int n = 0; n < 50; ++n) {
    const auto e = S::Velocity::from_raw(static_cast<std::int32_t>(test::drawn_between(-3000000, 3000000)));  // 11 mm/s
    const auto y = Fixed::step(c, state, e, saturations).output;
    sum += e.raw();
    const Int128 integral = sum * c.integral.raw();
    RC_ASSERT(Int128{state.integral.raw()} == integral);
    const Int128 exact = test::rescaled(integral, integral_bits, bits) +
                         test::rescaled(Int128{c.proportional.raw()} * e.raw(), proportional_bits, bits);
    RC_ASSERT(std::int64_t{y.raw()} == test::expected_raw<S::Current>(exact, bits));
  }
  RC_ASSERT(saturations.count == 0u);
}

template <class PiOf, class Velocity, class C>
void check_step_response(const C& c, double tolerance) {
  typename PiOf::State state;
  SaturationCounter saturations;
  const double e = 0x1p-8;  // m/s
  for (int n = 1; n <= 1600; ++n) {
    const double y = machine::to_si(PiOf::step(c, state, machine::to_signal<Velocity>(e).value(), saturations).output);
    // The integrator counts the current error: the sum at tick n is that of the continuous law at n T.
    ASSERT_NEAR(y, 600.0 * e * (1.0 + n * tick / 5e-3), tolerance) << n;
  }
}

TEST(Pi, StepResponseIsThatOfTheContinuousLawAtTheEndOfEachTick) {
  check_step_response<Fixed, S::Velocity>(fixed_config(600.0, 5e-3), 0x1p-20);  // one bit of the current
  check_step_response<Real, machine::Real>(real_config(600.0, 5e-3), 1e-11);    // 1600 roundings of double at 50 A
}

TEST(Pi, WithoutAnIntegralGainIsProportional) {
  Fixed::Config c;
  c.proportional = machine::to_signal<S::VelocityGain>(250.0).value();
  Fixed::State state;
  SaturationCounter saturations;
  for (int n = 0; n < 100; ++n) {
    const double e = 0x1p-10 * (n % 7 - 3);
    const auto wanted = Fixed::step(c, state, machine::to_signal<S::Velocity>(e).value(), saturations);
    EXPECT_EQ(machine::to_si(wanted.output), 250.0 * e);
    Fixed::track(c, state, wanted.beyond_format, wanted.output, {}, saturations);  // fully limited
    EXPECT_EQ(state.integral.raw(), 0);
  }
}

// Runs a limited controller and tells what the limit let pass.
template <class PiOf, class Velocity>
double limited_step(const typename PiOf::Config& c, typename PiOf::State& state, double e, double limit) {
  SaturationCounter saturations;
  const auto wanted = PiOf::step(c, state, machine::to_signal<Velocity>(e).value(), saturations);
  using Output = std::remove_const_t<decltype(wanted.output)>;
  const auto given = machine::to_signal<Output>(std::clamp(machine::to_si(wanted.output), -limit, limit)).value();
  PiOf::track(c, state, wanted.beyond_format, wanted.output, given, saturations);
  return machine::to_si(given);
}

TEST(Pi, WhileTheLimitHoldsTheIntegratorTendsToTheLimitWithTheTimeConstantOfTheTracking) {
  const auto c = real_config(600.0, 5e-3);
  Real::State state;
  for (int n = 1; n <= 800; ++n) {
    limited_step<Real, machine::Real>(c, state, 0.5, 40.0);
    // I(n) = I* (1 - (1 - T/T_N)^n), I* = limit - K_i e: the recursion's closed form.
    const double rest = 40.0 - 600.0 * tick / 5e-3 * 0.5;
    ASSERT_NEAR(machine::to_si(state.integral), rest * (1.0 - std::pow(1.0 - tick / 5e-3, n)), 1e-9) << n;
  }
}

TEST(Pi, AfterASecondAtTheLimitTheOutputLeavesItInTheTickInWhichTheErrorReverses) {
  for (const double reversed : {-1e-6, -1e-3, -0.05}) {
    const auto c = fixed_config(600.0, 5e-3);
    Fixed::State state;
    for (int n = 0; n < 16000; ++n) ASSERT_EQ((limited_step<Fixed, S::Velocity>(c, state, 0.5, 40.0)), 40.0);
    EXPECT_LT((limited_step<Fixed, S::Velocity>(c, state, reversed, 40.0)), 40.0) << reversed;
  }
}

TEST(Pi, AnErrorThatSaturatesTheOutputsOwnFormatDoesNotWindTheIntegratorUp) {
  // The Y axis: 1200 A s/m * 2 m/s = 2400 A, beyond the format's 2048 A. What the saturation hides from the tracking
  // must not stay in the integrator: as for smaller errors it may not rest beyond the limit.
  const auto c = fixed_config(1200.0, 4.4e-3);
  Fixed::State state;
  for (int n = 0; n < 16000; ++n) limited_step<Fixed, S::Velocity>(c, state, 2.0, 80.0);
  EXPECT_LE(std::abs(machine::to_si(state.integral)), 80.0);
  EXPECT_LT((limited_step<Fixed, S::Velocity>(c, state, -1e-2, 80.0)), 80.0);
}

TEST(Pi, WithoutALimitTrackingChangesNothing) {
  const auto c = fixed_config(600.0, 5e-3);
  Fixed::State state;
  SaturationCounter saturations;
  const auto y = Fixed::step(c, state, machine::to_signal<S::Velocity>(0.01).value(), saturations);
  const auto before = state.integral;
  Fixed::track(c, state, y.beyond_format, y.output, y.output, saturations);
  EXPECT_EQ(state.integral, before);
}

RC_GTEST_PROP(Pi, FixedPointFollowsDoubleWithinItsRounding, ()) {
  // Gains that the formats hold exactly, so that only the signals' rounding remains.
  const auto fixed = fixed_config(600.0, 5e-3);
  const auto real = real_config(600.0, 5e-3);
  Fixed::State a;
  Real::State b;
  SaturationCounter saturations;
  for (int n = 0; n < 200; ++n) {
    const auto e = S::Velocity::from_raw(static_cast<std::int32_t>(test::drawn_between(-2000000, 2000000)));
    const double y = machine::to_si(Fixed::step(fixed, a, e, saturations).output);
    const double z = machine::to_si(Real::step(real, b, {machine::to_si(e)}, saturations).output);
    // Half a bit, and double's own rounding of sums up to 15 A.
    RC_ASSERT(std::abs(y - z) <= 0x1p-21 + 1e-11);
  }
}

}  // namespace
}  // namespace stiction
