// What the axis makes of its feedback: time stamps, aged samples, samples that are missing or seen before.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::FixedBench;
using test::si;
using test::tick_ns;

constexpr double speed = 0.8;  // m/s, 48 m/min

// Set-points of a constant speed from the tick's own time.
void move_set(FixedBench& b, double v) {
  const double t = 1e-9 * static_cast<double>(b.ticker.now_ns());
  b.set.position = si<S::Position>(v * t);
  b.set.velocity = si<S::Velocity>(v);
}
// The encoder's sample `age_ns` before the tick.
void move_sample(FixedBench& b, double v, std::int64_t age_ns) {
  b.feedback.position_time_ns = b.ticker.now_ns() - age_ns;
  b.feedback.position = si<S::Position>(v * 1e-9 * static_cast<double>(b.feedback.position_time_ns));
}

// Each sampled position is rounded to 2^-40 m; their difference over a tick of 62.5 us is off by 2^-40 * 16000 m/s = 4
// bits of the velocity; the products round one more.
constexpr std::int32_t velocity_bits = 6;

TEST(AxisFeedback, AtConstantSpeedAnAgedSampleMeansNoError) {
  for (const std::int64_t age_ns : {0, 1, 12345, 31250, 62499}) {
    FixedBench b;
    for (int i = 0; i < 100; ++i) {
      move_set(b, speed);
      move_sample(b, speed, age_ns);
      b.tick_as_it_is();
      if (i < 4) continue;  // the start from rest
      // The set-point taken back by v * age is off by 8e-8 of 50 um and three roundings of 2^-40 m: far below half a
      // bit of the error, 0.12 nm.
      ASSERT_EQ(b.signals.e.raw(), 0) << "age " << age_ns << " ns, tick " << i;
      ASSERT_LE(std::abs(b.signals.v_error.raw()), velocity_bits) << "age " << age_ns << " ns, tick " << i;
    }
  }
}

TEST(AxisFeedback, WithoutItsAgeTheSameSampleWouldBeAnErrorOfSpeedTimesAge) {
  FixedBench b;
  for (int i = 0; i < 100; ++i) {
    move_set(b, speed);
    move_sample(b, speed, 31250);
    b.feedback.position_time_ns = b.ticker.now_ns();  // a drive that takes the sample for a fresh one
    b.tick_as_it_is();
  }
  EXPECT_NEAR(machine::to_si(b.signals.e), speed * 31250e-9, 1e-9);
}

TEST(AxisFeedback, AtConstantAccelerationTheSetSpeedIsReadAtTheTimeOfTheMeasuredOne) {
  constexpr double a = 20.0;  // m/s^2, the cross table's largest
  for (const std::int64_t age_ns : {0, 20000, 62499}) {
    FixedBench b;
    for (int i = 0; i < 400; ++i) {
      const double t = 1e-9 * static_cast<double>(b.ticker.now_ns());
      b.set = {si<S::Position>(0.5 * a * t * t), si<S::Velocity>(a * t), si<S::Acceleration>(a), true};
      const double then = t - 1e-9 * static_cast<double>(age_ns);
      b.feedback.position_time_ns = b.ticker.now_ns() - age_ns;
      b.feedback.position = si<S::Position>(then > 0.0 ? 0.5 * a * then * then : 0.0);
      b.tick_as_it_is();
      if (i < 5) continue;
      // Without the delay the difference would be a * (half a tick + age), 6e-4 m/s and more: 2e5 bits.
      ASSERT_LE(std::abs(b.signals.v.raw() - b.signals.v_set_delayed.raw()), velocity_bits)
          << "age " << age_ns << " ns, tick " << i;
      // The set-point is taken back along its tangent: a * age^2 / 2 = 39 nm at most stays.
      const double age = 1e-9 * static_cast<double>(age_ns);
      ASSERT_NEAR(machine::to_si(b.signals.e), -0.5 * a * age * age, 5e-10) << "age " << age_ns << " ns, tick " << i;
    }
  }
}

TEST(AxisFeedback, OneOrTwoMissingSamplesAtConstantSpeedAreNoError) {
  // The rate of three ticks, 5333.3 1/s, is rounded to 2^-10: 0.8 m/s * 2^-11 / 5333 = 20 bits more.
  constexpr std::int32_t rate_bits = 20;
  for (const int missing : {1, 2}) {
    FixedBench b;
    for (int i = 0; i < 100; ++i) {
      move_set(b, speed);
      const bool valid = i < 10 || i % 7 >= missing;
      b.feedback.position_valid = valid;
      if (valid)
        move_sample(b, speed, 0);
      else
        b.feedback.position = si<S::Position>(-0.123), b.feedback.position_time_ns = 77;  // what a failed read leaves
      b.tick_as_it_is();
      if (i < 4) continue;
      ASSERT_EQ(b.axis.fault(), Fault::none);
      ASSERT_EQ(b.signals.e.raw(), 0) << "tick " << i;
      ASSERT_LE(std::abs(b.signals.v_error.raw()), velocity_bits + rate_bits) << "tick " << i;
    }
  }
}

TEST(AxisFeedback, AMissingSampleAtATickOfAMillisecondIsNoErrorEither) {
  // Two missing samples are 2 ms old: at 0.5 m/s the set-point must be taken back by 1 mm.
  auto config = test::bench_config<S>();
  config.period_ns = 1000000;
  config.inverse_period = si<S::PeriodInverse>(1e-6);
  FixedBench b(config);
  b.ticker = Ticker(1000000, 1);
  for (int i = 0; i < 50; ++i) {
    move_set(b, 0.5);
    b.feedback.position_valid = i < 10 || i % 7 >= 2;
    if (b.feedback.position_valid) move_sample(b, 0.5, 0);
    b.tick_as_it_is();
    if (i < 4) continue;
    ASSERT_NEAR(machine::to_si(b.signals.e), 0.0, 1e-9) << "tick " << i;
  }
}

TEST(AxisFeedback, AMissingSampleLeavesPositionAndVelocityAsTheyWere) {
  FixedBench b;
  for (int i = 0; i < 10; ++i) {
    move_sample(b, speed, 0);
    move_set(b, speed);
    b.tick_as_it_is();
  }
  const auto before = b.signals;
  b.feedback.position_valid = false;
  b.feedback.position = si<S::Position>(1.0);
  b.tick();
  EXPECT_EQ(b.signals.x, before.x);
  EXPECT_EQ(b.signals.v, before.v);
}

TEST(AxisFeedback, ThreeMissingSamplesInARowTripButNotThreeInFour) {
  FixedBench b;
  for (int i = 0; i < 400; ++i) {
    b.feedback.position_valid = i % 3 == 0;
    b.tick();
    ASSERT_EQ(b.axis.fault(), Fault::none) << "tick " << i;
  }
  FixedBench lost;
  lost.feedback.position_valid = false;
  lost.tick();
  lost.tick();
  EXPECT_EQ(lost.axis.fault(), Fault::none);
  lost.tick();
  EXPECT_EQ(lost.axis.fault(), Fault::position_lost);
}

TEST(AxisFeedback, ASampleSeenBeforeChangesNothing) {
  FixedBench b;
  for (int i = 0; i < 10; ++i) {
    move_sample(b, speed, 0);
    move_set(b, speed);
    b.tick_as_it_is();
  }
  const auto before = b.signals;
  b.feedback.position = si<S::Position>(1.0);  // the stamp of the last tick, another value
  b.tick_as_it_is();
  EXPECT_EQ(b.signals.x, before.x);
  EXPECT_EQ(b.signals.v, before.v);
  b.feedback.position_time_ns -= 5 * tick_ns;  // an older one
  b.tick_as_it_is();
  EXPECT_EQ(b.signals.x, before.x);
  EXPECT_EQ(b.signals.v, before.v);
}

TEST(AxisFeedback, AnEncoderThatRepeatsOneValidSampleIsAPositionLost) {
  // A frozen encoder is as blind as a missing one: at standstill no other supervision could see it.
  FixedBench b;
  for (int i = 0; i < 10; ++i) b.tick();
  for (int i = 0; i < 10; ++i) b.tick_as_it_is();  // the stamp stands still, the sample is called valid
  EXPECT_EQ(b.axis.fault(), Fault::position_lost);
  EXPECT_FALSE(b.command.enable);
}

TEST(AxisFeedback, ATimeStampFarAheadIsRefusedAndTheNextSampleTaken) {
  // Taken, one corrupt stamp would make every later sample "seen before".
  FixedBench b;
  for (int i = 0; i < 10; ++i) b.tick();
  b.tick(-1000000000);  // a second ahead
  for (int i = 0; i < 100; ++i) b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::none);
  EXPECT_EQ(b.axis.state().estimator.t1_ns, b.feedback.position_time_ns);
}

TEST(AxisFeedback, StartsAtRestAtTheMeasuredPosition) {
  FixedBench b;
  b.hold_at(1.234);
  b.start();
  for (int i = 0; i < 5; ++i) {
    b.tick();
    EXPECT_EQ(b.axis.fault(), Fault::none);
    EXPECT_EQ(b.signals.e.raw(), 0);
    EXPECT_EQ(b.signals.v.raw(), 0);
    EXPECT_EQ(b.command.voltage[0].raw(), 0);
  }
}

TEST(AxisFeedback, ThePositionErrorIsHeldBetweenSlowTicksAndQuantised) {
  auto config = test::bench_config<S>();
  config.quantizer = {true, si<S::IncrementInverse>(1e6), si<S::Increment>(1e-6)};
  FixedBench b(config);
  for (int i = 0; i < 64; ++i) {
    const double e = 1e-7 * i;  // 0.1 um more per tick: 1.6 um between slow ticks
    b.set.position = si<S::Position>(e);
    b.tick();
    const double sampled = 1e-7 * (i / 16 * 16);
    EXPECT_NEAR(machine::to_si(b.signals.e), e, 1.3e-10);  // half a bit and the set-point's
    EXPECT_NEAR(machine::to_si(b.signals.e_held), 1e-6 * std::round(sampled * 1e6), 1.3e-10) << i;
  }
}

TEST(AxisFeedback, AGivenVelocityIsTakenAsItIs) {
  auto config = test::bench_config<S>();
  config.velocity_feedback = VelocityFeedback::given;
  FixedBench b(config);
  b.feedback.velocity = si<S::Velocity>(0.03);
  b.tick();
  EXPECT_EQ(b.signals.v, b.feedback.velocity);
}

}  // namespace
}  // namespace stiction
