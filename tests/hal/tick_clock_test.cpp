#include "hal/tick_clock.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "hal/loop_timing.hpp"
#include "hal/paced_backend.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/hal/fake_time.hpp"

namespace stiction::test {
namespace {

constexpr std::int64_t period_ns = 62'500;
using Clock = hal::BasicTickClock<FakeTime>;

// The clock after a first tick in time.
struct Started {
  FakeClock time;
  Clock clock{period_ns, {&time}};
  std::int64_t first_ns = clock.wait();

  std::int64_t wait_late(std::int64_t late_ns) {
    time.late_ns = {late_ns};
    return clock.wait();
  }
};

TEST(TickClock, TicksAPeriodApartHoweverLateEachBegins) {
  Started s;
  for (int i = 1; i <= 100; ++i) EXPECT_EQ(s.wait_late(i % 7 * 5000), s.first_ns + i * period_ns);
  EXPECT_EQ(s.clock.missed(), 0u);
  EXPECT_EQ(s.clock.fault(), Fault::none);
}

TEST(TickClock, IsShiftedToAnotherClockForAllTicksToCome) {
  Started s;
  s.clock.shift(200);
  EXPECT_EQ(s.wait_late(0), s.first_ns + period_ns + 200);
  s.clock.shift(-50);
  for (int i = 2; i <= 10; ++i) EXPECT_EQ(s.wait_late(0), s.first_ns + i * period_ns + 150);
  EXPECT_EQ(s.clock.missed(), 0u);
}

TEST(TickClock, LetsALateTickTakeThePlaceOfThoseMissed) {
  Started s;
  EXPECT_EQ(s.wait_late(5 * period_ns + 100), s.first_ns + 6 * period_ns);
  EXPECT_EQ(s.clock.missed_before(), 5u);
  EXPECT_EQ(s.wait_late(0), s.first_ns + 7 * period_ns);
  EXPECT_EQ(s.clock.missed_before(), 0u);
  EXPECT_EQ(s.clock.missed(), 5u);
}

// Who waits for answers from the tick's time on would otherwise wait for the missed ticks once more, and be late again.
TEST(TickClock, CountsTheLatenessOfATickFromTheTimeThatItGives) {
  Started s;
  for (const std::int64_t late_ns : {0L, 100L, period_ns - 1, period_ns, 5 * period_ns + 100}) {
    const std::int64_t tick_ns = s.wait_late(late_ns);
    EXPECT_EQ(tick_ns + s.clock.lateness_ns(), s.time.now_ns) << late_ns;
  }
  EXPECT_EQ(s.clock.lateness().read().maximum, 5 * period_ns + 100);
}

TEST(TickClock, BearsOneMissedTick) {
  Started s;
  s.wait_late(period_ns);
  EXPECT_EQ(s.clock.missed_before(), 1u);
  EXPECT_EQ(s.clock.fault(), Fault::none);
  s.wait_late(period_ns - 1);
  EXPECT_EQ(s.clock.missed_before(), 0u);
  s.wait_late(period_ns);  // one in a row again
  EXPECT_EQ(s.clock.fault(), Fault::none);
  EXPECT_EQ(s.clock.missed(), 2u);
}

TEST(TickClock, FaultsAtTheSecondLateTickInARow) {
  Started s;
  s.wait_late(period_ns + 1);
  EXPECT_EQ(s.clock.fault(), Fault::none);
  s.wait_late(period_ns + 1);
  EXPECT_EQ(s.clock.fault(), Fault::missed_deadline);
  s.wait_late(0);
  EXPECT_EQ(s.clock.fault(), Fault::none);
}

TEST(TickClock, FaultsWhenTwoTicksAreLeftOutAtOnce) {
  Started s;
  s.wait_late(2 * period_ns);
  EXPECT_EQ(s.clock.fault(), Fault::missed_deadline);
}

TEST(TickClock, SeesAClockThatWentBackAndGoesOnFromThereAtOnce) {
  Started s;
  s.time.now_ns -= 3'600'000'000'000;
  const std::int64_t now = s.time.now_ns;
  EXPECT_EQ(s.clock.wait(), now);  // without sleeping for an hour
  EXPECT_EQ(s.clock.fault(), Fault::clock_jump);
  EXPECT_EQ(s.clock.jumps(), 1u);
  EXPECT_EQ(s.wait_late(0), now + period_ns);
  EXPECT_EQ(s.clock.fault(), Fault::none);
}

TEST(TickClock, SeesAClockThatWentOnByMoreThan100Milliseconds) {
  Started s;
  s.wait_late(Clock::jump_ns - period_ns);  // 100 ms after the tick before: late, but no jump
  EXPECT_EQ(s.clock.fault(), Fault::missed_deadline);
  s.wait_late(0);
  const auto missed = s.clock.missed();
  s.wait_late(Clock::jump_ns);
  EXPECT_EQ(s.clock.fault(), Fault::clock_jump);
  EXPECT_EQ(s.clock.missed(), missed);  // a jump says nothing of how many ticks there should have been
}

TEST(TickClock, SeesAJumpDuringTheWorkOfATick) {
  Started s;
  s.time.now_ns += Clock::jump_ns + 1;
  s.clock.wait();
  EXPECT_EQ(s.clock.fault(), Fault::clock_jump);
}

TEST(TickClock, StartsAgainWhenToldTo) {
  Started s;
  s.time.now_ns += 10 * Clock::jump_ns;
  s.clock.restart();
  const std::int64_t start = s.time.now_ns;
  EXPECT_EQ(s.clock.wait(), start + period_ns);
  EXPECT_EQ(s.clock.fault(), Fault::none);
  EXPECT_EQ(s.clock.missed(), 0u);
}

// CLOCK_MONOTONIC stands still while the computer sleeps: only the other clock tells.
TEST(TickClock, SeesThatTheComputerWasSuspendedOnceASuspension) {
  Started s;
  s.wait_late(0);
  for (const std::int64_t suspended_ns : {1'000'000LL, 8 * 3'600'000'000'000LL}) {
    s.time.suspended_ns += suspended_ns;
    s.wait_late(10);
    EXPECT_TRUE(s.clock.was_suspended()) << suspended_ns;
    EXPECT_EQ(s.clock.fault(), Fault::clock_jump);
    s.wait_late(0);
    EXPECT_FALSE(s.clock.was_suspended());
    EXPECT_EQ(s.clock.fault(), Fault::none);
  }
  EXPECT_EQ(s.clock.jumps(), 2u);
  EXPECT_EQ(s.clock.missed(), 0u);
}

TEST(TickClock, TakesNoDelayBetweenItsReadingsForASuspension) {
  FakeClock time;
  time.suspended_ns = 3'600'000'000'000;  // before the start of the programme
  for (const std::int64_t work_ns : {0, 30, 20'000}) {
    time.work_per_reading_ns = work_ns;
    Clock clock{period_ns, {&time}};
    for (int i = 0; i < 100; ++i) {
      time.work_per_reading_ns = i % 3 == 0 ? work_ns : 0;
      clock.wait();
      ASSERT_FALSE(clock.was_suspended()) << i;
    }
  }
}

// The kernel's tick is at multiples of 1, 4 or 10 ms (CONFIG_HZ) and of nothing shorter than 1 ms. An interrupt there
// keeps others off for some microseconds: at a loop's deadline that would be so in the same ticks of every second.
TEST(TickClock, KeepsClearOfTheKernelsOwnTickFromEveryStartAndAfterAJump) {
  constexpr std::int64_t kernel_ns = 1'000'000;
  for (const std::int64_t period : {62'500, 125'000, 250'000, 500'000, 1'000'000, 2'000'000, 10'000'000})
    for (std::int64_t begin_ns = 1'000'000'000; begin_ns < 1'001'000'000; begin_ns += 3'917) {
      FakeClock time;
      time.now_ns = begin_ns;
      Clock clock(period, {&time});
      clock.keep_clear_of_kernel_tick();
      const std::int64_t first_ns = clock.wait();
      EXPECT_LT(first_ns, begin_ns + 2 * period);
      std::int64_t tick_ns = first_ns;
      for (int tick = 1; tick < 40; ++tick) {
        const bool jumped = tick == 20;
        if (jumped) time.now_ns += Clock::jump_ns + 777'777;
        tick_ns = clock.wait();
        if (jumped) continue;  // at once
        EXPECT_GE(tick_ns % kernel_ns, 46'000) << period << ' ' << begin_ns;
        EXPECT_LE(tick_ns % kernel_ns, kernel_ns - 15'000) << period << ' ' << begin_ns;
      }
      EXPECT_EQ(clock.missed(), 0u);
    }
}

TEST(TickClock, CountsHowLateEveryTickBegan) {
  Started s;
  for (const std::int64_t late : {10, 10, 3000, 70'000}) s.wait_late(late);
  const auto counts = s.clock.lateness().read();
  EXPECT_EQ(counts.total, 5u);
  EXPECT_EQ(counts.counts[hal::time_bins::index_of(10)], 2u);
  EXPECT_EQ(counts.maximum, 70'000);
  EXPECT_EQ(counts.minimum, 0);
  EXPECT_EQ(counts.quantile(0.5), 10);
  EXPECT_NEAR(counts.mean, (0 + 10 + 10 + 3000 + 70'000) / 5.0, 1e-9);
}

TEST(TimeHistogram, BinsFollowOneAnotherWithoutAGapAndAreASixtyFourthWide) {
  for (std::size_t bin = 0; bin < hal::time_bins::count; ++bin) {
    const auto begin = hal::time_bins::begin_of(bin);
    const auto end = hal::time_bins::begin_of(bin + 1);
    ASSERT_EQ(hal::time_bins::index_of(begin), bin);
    ASSERT_EQ(hal::time_bins::index_of(end - 1), bin);
    ASSERT_LE(static_cast<double>(end - begin), std::max(1.0, static_cast<double>(begin) / 64.0));
  }
  EXPECT_EQ(hal::time_bins::index_of(-5), 0u);
  EXPECT_EQ(hal::time_bins::index_of(INT64_MAX), hal::time_bins::count - 1);
}

// The bound of a lateness at 125 us (tests/rt): bins an eighth of their times wide called 11.3 us "12.29 us".
TEST(TimeHistogram, TellsATimeBelowABoundOfTwelveMicrosecondsFromOneAboveIt) {
  for (const std::int64_t late : {11'300, 11'850, 12'050}) {
    hal::TimeHistogram histogram;
    for (int i = 0; i < 1000; ++i) histogram.add(late);
    histogram.add(40'000);
    EXPECT_EQ(histogram.read().quantile(0.999) <= 12'000, late <= 12'000) << late;
    EXPECT_EQ(histogram.maximum(), 40'000);
  }
}

TEST(TimeHistogram, QuantileIsTheEndOfItsBinAndNeverBeyondTheMaximum) {
  hal::TimeHistogram histogram;
  EXPECT_EQ(histogram.read().quantile(0.5), 0);
  for (int i = 1; i <= 1000; ++i) histogram.add(i * 100);
  const auto counts = histogram.read();
  EXPECT_GE(counts.quantile(0.5), 50'000);
  EXPECT_LE(counts.quantile(0.5), 50'000 * 65 / 64);  // a bin's width
  EXPECT_EQ(counts.quantile(1.0), 100'000);
}

// A backend that takes a known time for each call.
struct SlowBackend {
  using Signals = FixedSignals;
  FakeClock* clock;
  int ticks = 0;

  std::size_t axis_count() const { return 1; }
  std::int64_t wait_for_tick() {
    clock->now_ns += 1000;
    return ++ticks * period_ns;
  }
  void read(std::span<Feedback<Signals>>) { clock->now_ns += 200; }
  void write(std::span<const Command<Signals>>) { clock->now_ns += 500; }
};

TEST(LoopTiming, GivesEachPartOfATickItsOwnTime) {
  FakeClock time;
  SlowBackend slow{&time};
  hal::BasicLoopTiming<FakeTime> timing{{&time}};
  hal::TimedBackend<SlowBackend, FakeTime> timed(slow, timing);
  static_assert(hal::Backend<decltype(timed)>);
  std::array<Feedback<FixedSignals>, 1> feedback;
  std::array<Command<FixedSignals>, 1> command;
  for (int i = 0; i < 10; ++i) {
    timed.wait_for_tick();
    timed.read(feedback);
    time.now_ns += 30;
    timing.lap(hal::LoopPart::trace);
    time.now_ns += 40;
    timing.lap(hal::LoopPart::set_point);
    time.now_ns += 100;
    timed.write(command);
  }
  timed.wait_for_tick();
  const auto mean = [&](hal::LoopPart part) { return timing.part(part).read().mean; };
  EXPECT_EQ(mean(hal::LoopPart::wait), 1000.0);
  EXPECT_EQ(mean(hal::LoopPart::read), 200.0);
  EXPECT_EQ(mean(hal::LoopPart::trace), 30.0);
  EXPECT_EQ(mean(hal::LoopPart::set_point), 40.0);
  EXPECT_EQ(mean(hal::LoopPart::control), 100.0);
  EXPECT_EQ(mean(hal::LoopPart::write), 500.0);
  EXPECT_EQ(timing.work().read().mean, 870.0);
  EXPECT_EQ(timing.work().read().total, 10u);
}

TEST(PacedBackend, LetsMissedTicksPassInTheWorldBehindIt) {
  FakeClock time;
  FakeClock elsewhere;
  SlowBackend world{&elsewhere};
  hal::PacedBackend<SlowBackend, FakeTime> paced(world, period_ns, {&time});
  static_assert(hal::WiredBackend<decltype(paced)>);
  EXPECT_EQ(paced.wait_for_tick(), period_ns);
  time.late_ns = {3 * period_ns};
  EXPECT_EQ(paced.wait_for_tick(), 5 * period_ns);
  EXPECT_EQ(paced.fault(0), Fault::missed_deadline);
  EXPECT_EQ(paced.wait_for_tick(), 6 * period_ns);
  EXPECT_EQ(paced.fault(0), Fault::none);
}

}  // namespace
}  // namespace stiction::test
