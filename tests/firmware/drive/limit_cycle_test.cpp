// The fault of a loop that swings between its limits, and what must not be taken for it.
#include <gtest/gtest.h>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::FixedBench;
using test::si;

FixedBench bench() {
  auto config = test::bench_config<S>();
  config.velocity_feedback = VelocityFeedback::given;
  config.velocity.integral = {};  // proportional: the output follows the sign of the velocity at once
  config.velocity.tracking = {};
  config.current.integral = {};
  config.current.tracking = {};
  FixedBench b(config);
  b.tick();
  return b;
}

// One tick with the current held at the limit of `side`: 600 A s/m * 0.1 m/s = 60 A, wanted beyond 40 A.
void push(FixedBench& b, int side) {
  b.feedback.velocity = si<S::Velocity>(-0.1 * side);
  b.tick();
}

constexpr int changes_allowed = 12;  // fault_table: "more than 12 times in 125 ms"
constexpr int window = 2000;         // ticks, 125 ms

TEST(LimitCycle, TripsAtTheThirteenthChangeOfSideAndDisablesInTheSameTick) {
  auto b = bench();
  push(b, 1);
  for (int change = 1; change <= changes_allowed; ++change) {
    push(b, change % 2 ? -1 : 1);
    ASSERT_EQ(b.axis.fault(), Fault::none) << "change " << change;
  }
  const auto now = b.ticker.now_ns();
  push(b, -1);
  EXPECT_EQ(b.axis.fault(), Fault::limit_cycle);
  EXPECT_EQ(b.axis.fault_time_ns(), now);
  EXPECT_FALSE(b.command.enable);
  EXPECT_EQ(b.command.voltage[0].raw(), 0);
}

TEST(LimitCycle, CountsAChangeAcrossTicksWithoutALimit) {
  auto b = bench();
  for (int i = 0; i <= changes_allowed; ++i) {
    push(b, i % 2 ? -1 : 1);
    ASSERT_EQ(b.axis.fault(), Fault::none);
    for (int k = 0; k < 20; ++k) push(b, 0);
  }
  push(b, -1);
  EXPECT_EQ(b.axis.fault(), Fault::limit_cycle);
}

TEST(LimitCycle, DoesNotCountTheSameLimitTouchedAgainAndAgain) {
  auto b = bench();
  for (int i = 0; i < 4000; ++i) push(b, i % 2);
  EXPECT_EQ(b.axis.fault(), Fault::none);
}

TEST(LimitCycle, DoesNotTripOnALimitHeldForSeconds) {
  auto b = bench();
  for (int i = 0; i < 32000; ++i) push(b, 1);
  EXPECT_EQ(b.axis.fault(), Fault::none);
}

TEST(LimitCycle, DoesNotTripBelow48HertzHoweverLong) {
  // 47 Hz: a half period of 170 ticks, 11.8 changes in 125 ms.
  auto b = bench();
  for (int i = 0; i < 16000 * 10; ++i) push(b, i / 170 % 2 ? -1 : 1);
  EXPECT_EQ(b.axis.fault(), Fault::none);
}

TEST(LimitCycle, TripsOnA60HertzCycleWithinTwoWindowsWhereverItStarts) {
  for (int start = 0; start < window; start += 97) {
    auto b = bench();
    for (int i = 0; i < start; ++i) push(b, 0);
    int ticks = 0;
    while (b.axis.fault() == Fault::none && ticks <= 2 * window) {
      push(b, ticks / 133 % 2 ? -1 : 1);
      ++ticks;
    }
    EXPECT_LE(ticks, 2 * window) << "start " << start;
  }
}

TEST(LimitCycle, IsSeenInTheVoltageTooWhereTheCurrentIsNotAtItsLimit) {
  auto b = bench();
  b.feedback.velocity = {};
  // 35 V/A * 10 A = 350 V, wanted beyond 300 V; the current stays far below its fault.
  for (int i = 0; i <= changes_allowed + 1; ++i) {
    ASSERT_EQ(b.axis.fault(), Fault::none) << i;
    b.feedback.current[0] = si<S::Current>(i % 2 ? 10.0 : -10.0);
    b.tick();
  }
  EXPECT_EQ(b.axis.fault(), Fault::limit_cycle);
}

TEST(LimitCycle, IsNotAVoltageLimitReachedInEveryHalfTurnOfAFastCommutation) {
  // A short pitch: 24 mm at 1.4 m/s turns the phases at 58 Hz. Held at the DC link's limit, each phase changes its side
  // 14.6 times in 125 ms, as a healthy motor at its voltage limit does.
  auto config = test::bench_config<S>();
  config.velocity_feedback = VelocityFeedback::given;
  config.current_loop = CurrentLoop::three_phase;
  config.inverse_pole_pair_pitch = si<S::PitchInverse>(1.0 / 0.024);
  FixedBench b(config);
  for (int i = 0; i < 2 * window; ++i) {
    b.hold_at(1.4 * test::tick * i);
    b.set.velocity = si<S::Velocity>(1.4);
    b.feedback.velocity = si<S::Velocity>(i == 0 ? 0.0 : 1.37);  // 18 A wanted and never reached: 630 V
    b.tick();
  }
  EXPECT_EQ(b.axis.fault(), Fault::none);
}

TEST(LimitCycle, IsForgottenAtTheNextStart) {
  auto b = bench();
  for (int i = 0; i <= changes_allowed; ++i) push(b, i % 2 ? -1 : 1);
  b.start();
  for (int i = 0; i <= changes_allowed; ++i) push(b, i % 2 ? -1 : 1);
  EXPECT_EQ(b.axis.fault(), Fault::none);
}

}  // namespace
}  // namespace stiction
