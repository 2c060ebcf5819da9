// The limits of the cascade: they hold an output back, say so, and wind nothing up.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::FixedBench;
using test::si;

// Errors larger than a following error are allowed to reach the limits.
AxisConfig<S> config_without_faults() {
  auto config = test::bench_config<S>();
  config.following_error_fault = si<S::Distance>(0.4);
  config.over_current_fault = si<S::Current>(1000.0);
  config.velocity_feedback = VelocityFeedback::given;
  return config;
}

TEST(AxisLimiting, NoFlagIsSetInCalmOperation) {
  FixedBench b(config_without_faults());
  b.set.position = si<S::Position>(1e-6);
  for (int i = 0; i < 32; ++i) {
    b.tick();
    EXPECT_FALSE(b.signals.limiting.velocity || b.signals.limiting.current || b.signals.limiting.voltage);
  }
}

TEST(AxisLimiting, HoldsTheVelocityReferenceAtItsLimitInBothSigns) {
  for (const double sign : {1.0, -1.0}) {
    FixedBench b(config_without_faults());
    b.set.position = si<S::Position>(sign * 0.1);  // 83 1/s * 0.1 m = 8.3 m/s: beyond the format even
    b.tick();
    EXPECT_TRUE(b.signals.limiting.velocity);
    EXPECT_EQ(machine::to_si(b.signals.v_ref), sign * 1.5);
  }
}

TEST(AxisLimiting, AReferenceExactlyAtTheVelocityLimitIsNotLimiting) {
  FixedBench b(config_without_faults());
  b.set.velocity = si<S::Velocity>(1.5);  // full feedforward
  b.tick();
  b.tick();
  EXPECT_EQ(machine::to_si(b.signals.v_ref), 1.5);
  EXPECT_FALSE(b.signals.limiting.velocity);
}

TEST(AxisLimiting, HoldsTheSetCurrentBehindTheFeedforwardAtItsLimit) {
  for (const double sign : {1.0, -1.0}) {
    FixedBench b(config_without_faults());
    b.set.acceleration = si<S::Acceleration>(sign * 15.9);  // 39.75 A of feedforward
    b.tick();
    EXPECT_FALSE(b.signals.limiting.current);
    EXPECT_EQ(machine::to_si(b.signals.i_set), sign * 39.75);
    b.set.acceleration = si<S::Acceleration>(sign * 16.1);
    b.tick();
    EXPECT_TRUE(b.signals.limiting.current);
    EXPECT_EQ(machine::to_si(b.signals.i_set), sign * 40.0);
    EXPECT_NEAR(machine::to_si(b.signals.i_feedforward), sign * 40.25, 1e-6) << "the trace shows what was wanted";
  }
}

TEST(AxisLimiting, ATestSignalIsPartOfTheSetCurrentAndOfWhatTheLimitHoldsBack) {
  for (const double sign : {1.0, -1.0}) {
    FixedBench b(config_without_faults());
    b.set.injection = si<S::Current>(sign * 12.5);
    b.tick();
    EXPECT_EQ(machine::to_si(b.signals.i_set), sign * 12.5);
    EXPECT_EQ(machine::to_si(b.signals.i_notch), 0.0) << "the controllers have not answered yet";
    b.set.injection = si<S::Current>(sign * 40.5);
    b.tick();
    EXPECT_TRUE(b.signals.limiting.current);
    EXPECT_EQ(machine::to_si(b.signals.i_set), sign * 40.0);
  }
}

TEST(AxisLimiting, HoldsTheVoltageOfEachPhaseAtItsLimit) {
  auto config = config_without_faults();
  config.current_loop = CurrentLoop::three_phase;
  for (std::size_t phase = 0; phase < 3; ++phase) {
    FixedBench b(config);
    b.feedback.current[phase] = si<S::Current>(-9.0);  // 35 V/A * 9 A = 315 V, and the integral's first step
    b.tick();
    EXPECT_TRUE(b.signals.limiting.voltage);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(machine::to_si(b.command.voltage[k]), k == phase ? 300.0 : 0.0);
  }
}

TEST(AxisLimiting, WithoutACurrentLoopTheOutputIsLimitedAsVoltage) {
  auto config = config_without_faults();
  config.current_loop = CurrentLoop::none;
  config.voltage_limit = si<S::Voltage>(10.0);
  config.current_limit = si<S::Current>(30.0);
  FixedBench b(config);
  b.set.acceleration = si<S::Acceleration>(3.0);  // 7.5
  b.tick();
  EXPECT_EQ(machine::to_si(b.command.voltage[0]), 7.5);
  EXPECT_FALSE(b.signals.limiting.voltage);
  b.set.acceleration = si<S::Acceleration>(5.0);  // 12.5
  b.tick();
  EXPECT_EQ(machine::to_si(b.command.voltage[0]), 10.0);
  EXPECT_TRUE(b.signals.limiting.voltage);
}

// Fixed point of back-calculation: the integrator ends a step's own increment below the limit, so that the next step
// brings it to the limit exactly.
TEST(AxisLimiting, ASecondAtTheCurrentLimitLeavesTheIntegratorBelowTheLimit) {
  FixedBench b(config_without_faults());
  b.feedback.velocity = si<S::Velocity>(-0.5);  // 300 A wanted, 40 A given
  for (int i = 0; i < 16000; ++i) {
    b.tick();
    ASSERT_TRUE(b.signals.limiting.current);
    ASSERT_LE(std::abs(machine::to_si(b.signals.i_integral)), 300.0 * 0.0125 + 40.0) << "tick " << i;
  }
  // 40 A - K_i e = 40 A - 600 A s/m * 0.0125 * 0.5 m/s. The tracking's rounding, half a bit of the 264 A of excess per
  // tick, counts as often as the tracking takes ticks: 1 / 0.0125.
  const double rounding = std::ldexp(0.5, -S::VelocityTracking::fraction_bits) * 264.0 / 0.0125;
  EXPECT_NEAR(machine::to_si(b.signals.i_integral), 40.0 - 600.0 * 0.0125 * 0.5, rounding + 1e-5);
}

TEST(AxisLimiting, AfterASecondAtTheLimitAReversedErrorLeavesItInTheNextTick) {
  for (const double reversed : {1e-6, 1e-3, 0.1}) {
    FixedBench b(config_without_faults());
    b.feedback.velocity = si<S::Velocity>(-0.5);
    for (int i = 0; i < 16000; ++i) b.tick();
    b.feedback.velocity = si<S::Velocity>(reversed);
    b.tick();
    EXPECT_FALSE(b.signals.limiting.current) << reversed << " m/s";
    EXPECT_LT(machine::to_si(b.signals.i_set), 40.0) << reversed << " m/s";
  }
}

TEST(AxisLimiting, AfterASecondAtTheVoltageLimitAReversedErrorLeavesItInTheNextTick) {
  FixedBench b(config_without_faults());
  b.feedback.current[0] = si<S::Current>(-20.0);  // 700 V wanted, 300 V given
  for (int i = 0; i < 16000; ++i) {
    b.tick();
    ASSERT_TRUE(b.signals.limiting.voltage);
  }
  b.feedback.current[0] = si<S::Current>(0.01);
  b.tick();
  EXPECT_FALSE(b.signals.limiting.voltage);
  // 300 V less the increments of both errors: 35 V/A * (T / T_N) * 20 A, and 35 V/A * 0.01 A.
  EXPECT_NEAR(machine::to_si(b.command.voltage[0]), 300.0 - 35.0 * 20.0 * 62.5e-6 / 2e-3 - 0.35, 0.02);
}

TEST(AxisLimiting, AFeedforwardBeyondTheLimitDrawsTheIntegratorBackByItsExcess) {
  FixedBench b(config_without_faults());
  b.set.acceleration = si<S::Acceleration>(20.0);  // 50 A wanted, 40 A given: 10 A of excess
  for (int i = 0; i < 16000; ++i) b.tick();
  EXPECT_NEAR(machine::to_si(b.signals.i_integral), -10.0, 1e-3);
  b.set.acceleration = {};
  b.tick();
  EXPECT_NEAR(machine::to_si(b.signals.i_set), -10.0, 1e-3);
}

TEST(AxisLimiting, IsNoFault) {
  FixedBench b(config_without_faults());
  b.feedback.velocity = si<S::Velocity>(-0.5);
  b.set.position = si<S::Position>(0.1);
  for (int i = 0; i < 1000; ++i) b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::none);
  EXPECT_TRUE(b.command.enable);
}

TEST(AxisLimiting, NothingInternalSaturatesInOrdinaryOperation) {
  FixedBench b;
  for (int i = 0; i < 2000; ++i) {
    b.hold_at(1e-3 * std::sin(0.01 * i));
    b.tick();
  }
  EXPECT_EQ(b.axis.state().saturations.count, 0u);
}

}  // namespace
}  // namespace stiction
