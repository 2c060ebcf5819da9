// The ramp of a controlled stop against the kinematics of constant deceleration.
#include "stiction/motion/velocity_ramp.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using Ramp = VelocityRamp<S>;

constexpr double period = 62.5e-6;  // s

Ramp::Config config(double deceleration) {
  return {machine::to_signal<S::Velocity>(deceleration * period).value(), S::seconds(31250), S::rate(62500)};
}

struct Stop {
  double way, time, worst_step;  // m, s, m: of a position from the mean of both speeds
  Ramp::State end;
};

Stop stop(double x, double v, double deceleration) {
  SaturationCounter saturations;
  Ramp::State state{machine::to_signal<S::Position>(x).value(), machine::to_signal<S::Velocity>(v).value()};
  const auto c = config(deceleration);
  Stop result{};
  int ticks = 0;
  while (state.velocity != S::Velocity{} && ticks < 10'000'000) {
    const auto before = state;
    const auto a = Ramp::step(c, state, {}, saturations);
    const double v0 = machine::to_si(before.velocity), v1 = machine::to_si(state.velocity);
    const double step = machine::to_si(state.position) - machine::to_si(before.position);
    result.worst_step = std::max(result.worst_step, std::abs(step - 0.5 * (v0 + v1) * period));
    EXPECT_NEAR(machine::to_si(a), (v1 - v0) / period, 1e-6 * deceleration + 3e-7);
    EXPECT_LE(std::abs(v1), std::abs(v0));
    EXPECT_GE(v0 * v1, 0.0);
    ++ticks;
  }
  EXPECT_EQ(saturations.count, 0u);
  result.way = machine::to_si(state.position) - x;
  result.time = ticks * period;
  result.end = state;
  return result;
}

TEST(VelocityRamp, StopsWithinTheWayAndTimeOfConstantDeceleration) {
  for (const double v : {-7.9, -0.8, -1e-3, 1e-6, 0.02, 0.8, 1.33, 7.9})
    for (const double d : {0.5, 10.0, 20.0, 500.0}) {
      const auto s = stop(0.1, v, d);
      EXPECT_EQ(s.end.velocity, S::Velocity{});
      // The last tick takes what is left: at most one period more, and its way. Speeds have 3.7 nm/s, the change of a
      // tick half of that: 6e-5 of it at 0.5 m/s^2.
      EXPECT_NEAR(s.time, std::abs(v) / d, 1.01 * period + 6e-5 * std::abs(v) / d);
      EXPECT_NEAR(s.way, v * std::abs(v) / (2.0 * d), d * period * period + 6e-5 * v * v / (2.0 * d));
    }
}

TEST(VelocityRamp, KeepsPositionAndSpeedConsistentInEveryTick) {
  // Two roundings to 0.9 pm, and the period's to 2^-37 s: 1.7e-7 of 50 um, 5 nm on the whole stop of 32 mm.
  EXPECT_LT(stop(0.1, 0.8, 10.0).worst_step, 10e-12);
}

TEST(VelocityRamp, StaysAtRest) {
  SaturationCounter saturations;
  Ramp::State state{machine::to_signal<S::Position>(0.25).value(), {}};
  const auto before = state;
  EXPECT_EQ(Ramp::step(config(10.0), state, {}, saturations).raw(), 0);
  EXPECT_EQ(state.position, before.position);
  EXPECT_EQ(state.velocity, before.velocity);
}

RC_GTEST_PROP(VelocityRamp, ReachesAnyTargetFromAnySpeedExactlyAndWithoutOvershoot, ()) {
  const auto v = S::Velocity::from_raw(*rc::gen::arbitrary<std::int32_t>());
  const auto target = S::Velocity::from_raw(*rc::gen::arbitrary<std::int32_t>());
  const auto c = config(*rc::gen::element(100.0, 500.0));
  SaturationCounter saturations;
  Ramp::State state{{}, v};
  const bool up = target > v;
  for (int i = 0; i < 4000 && state.velocity != target; ++i) {
    const auto before = state.velocity;
    Ramp::step(c, state, target, saturations);
    const bool nearer =
        up ? state.velocity > before && state.velocity <= target : state.velocity < before && state.velocity >= target;
    RC_ASSERT(nearer);
  }
  RC_ASSERT(state.velocity == target);
}

}  // namespace
}  // namespace stiction
