// A loop that stands still: who takes its power, how soon, and what it finds when it goes on.
#include "firmware/stictiond/loop_watchdog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "hal/gated_backend.hpp"
#include "hal/tick_clock.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::test {
namespace {

constexpr std::int64_t watch_ms = 1'000'000;

// A power stage that only remembers whether it was cut.
struct Stage {
  int cuts = 0;
  void cut_power() noexcept { ++cuts; }
};

TEST(LoopWatch, CutsThePowerOfALoopThatStandsStillForLongerThanTheLimit) {
  hal::PowerCut cut;
  Stage stage;
  const hal::PowerCut::Entry entry(cut, stage);
  drive::LoopWatch watch(100 * watch_ms, cut);
  for (std::int64_t now = 0; now <= 1000; now += 10) watch.look(0, now * watch_ms);  // it has not begun
  EXPECT_EQ(stage.cuts, 0);
  for (std::uint64_t tick = 1; tick < 100; ++tick)
    watch.look(tick, static_cast<std::int64_t>(1000 + 10 * tick) * watch_ms);
  EXPECT_FALSE(cut.is_cut());
  for (std::int64_t still = 10; still <= 100; still += 10) watch.look(99, (1990 + still) * watch_ms);
  EXPECT_FALSE(cut.is_cut());
  watch.look(99, 2100 * watch_ms);
  EXPECT_TRUE(cut.is_cut());
  EXPECT_EQ(stage.cuts, 1);
}

// docs/safety.md: 110 ms from the last tick on, whenever that is between two looks; a stall within the limit is borne.
TEST(LoopWatch, CutsWithin110MillisecondsOfTheLastTickAndNotBeforeTheLimit) {
  constexpr std::int64_t limit_ns = drive::LoopWatchdog::limit_ns, round_ns = drive::LoopWatchdog::round_ns;
  for (std::int64_t last_tick_ns = 1000 * watch_ms; last_tick_ns < 1020 * watch_ms; last_tick_ns += watch_ms / 4) {
    hal::PowerCut cut;
    drive::LoopWatch watch(limit_ns, cut);
    std::int64_t now_ns = 0;
    for (; !cut.is_cut() && now_ns < 2000 * watch_ms; now_ns += round_ns)
      watch.look(static_cast<std::uint64_t>(1 + std::min(now_ns, last_tick_ns)), now_ns);
    const std::int64_t taken_ns = now_ns - round_ns - last_tick_ns;
    EXPECT_GE(taken_ns, limit_ns) << last_tick_ns;
    EXPECT_LE(taken_ns, 110 * watch_ms) << last_tick_ns;
  }
}

// A look comes before the loop on its processor: at the loop's deadline it would hold that tick up, in every such
// round.
TEST(LoopWatch, LooksWhereALoopOnTheSameProcessorHasNoDeadline) {
  constexpr std::int64_t round_ns = drive::LoopWatchdog::round_ns;
  for (const std::int64_t period : {62'500, 125'000, 250'000, 500'000, 1'000'000, 2'000'000, 10'000'000})
    for (const std::int64_t begin_ns : {1'000'000'000LL, 3'123'456'789LL, 86'400'004'999'999LL}) {
      const std::int64_t tick_ns = hal::clear_of_kernel_tick(begin_ns, period);
      for (std::int64_t look = 3; look < 50; ++look) {  // behind the first tick
        const std::int64_t look_ns = drive::LoopWatchdog::first_look_ns(begin_ns) + look * round_ns;
        const std::int64_t since_ns = (look_ns - tick_ns) % period;
        EXPECT_GE(since_ns, 15'000) << period;
        EXPECT_GE(period - since_ns, 46'000) << period;
      }
    }
}

TEST(PowerCut, ReachesEveryBackendThatIsEnteredAndNoneThatIsGone) {
  hal::PowerCut cut;
  Stage first, second;
  const hal::PowerCut::Entry stays(cut, first);
  {
    const hal::PowerCut::Entry goes(cut, second);
    cut.cut();
  }
  cut.cut();
  EXPECT_EQ(first.cuts, 2);
  EXPECT_EQ(second.cuts, 1);
}

TEST(LoopWatchdog, CutsBesideALoopThatNeverComesBack) {
  hal::PowerCut cut;
  struct Waking {
    std::atomic<bool> done{false};
    void cut_power() noexcept {
      done = true;
      done.notify_all();
    }
  } stage;
  const hal::PowerCut::Entry entry(cut, stage);
  const drive::LoopWatchdog watchdog([] { return std::uint64_t{7}; }, cut, 0);
  stage.done.wait(false);  // for ever, if it never cuts
  EXPECT_TRUE(cut.is_cut());
}

// A backend that keeps what was written.
struct Written {
  using Signals = FixedSignals;
  std::vector<Command<Signals>> commands = std::vector<Command<Signals>>(2);
  std::size_t axis_count() const { return commands.size(); }
  std::int64_t wait_for_tick() { return 0; }
  void read(std::span<Feedback<Signals>>) {}
  void write(std::span<const Command<Signals>> command) { commands.assign(command.begin(), command.end()); }
};

TEST(GatedBackend, LetsNoEnablingCommandThroughFromTheCutToItsRelease) {
  hal::PowerCut cut;
  Written backend;
  hal::GatedBackend<Written> gated(backend, cut);
  std::vector<Command<FixedSignals>> commands(2);
  for (auto& command : commands) {
    command.enable = true;
    command.voltage[0] = FixedSignals::Voltage::from_raw(1);
  }
  for (const bool is_cut : {false, true, false}) {
    is_cut ? cut.cut() : cut.release();
    gated.write(commands);
    for (const auto& command : backend.commands) {
      EXPECT_EQ(command.enable, !is_cut);
      EXPECT_EQ(command.voltage[0].raw(), is_cut ? 0 : 1);
    }
  }
}

// What a loop is asked in a tick, in order.
struct Asked {
  hal::PowerCut& cut;
  std::vector<std::string> order;
  void trip(Fault fault) { order.emplace_back(name_of(fault)); }
  void tick(bool stop_wanted) {
    order.emplace_back(std::string(stop_wanted ? "stop" : "tick") + (cut.is_cut() ? ", gate closed" : ""));
  }
};

TEST(TickUnderWatch, TripsTheFaultBeforeTheGateOpensAgain) {
  hal::PowerCut cut;
  Asked asked{cut, {}};
  cut.cut();
  for (int i = 0; i < 2; ++i) drive::tick_under_watch(asked, asked, cut, false, false);
  EXPECT_EQ(asked.order, (std::vector<std::string>{"watchdog starved", "tick, gate closed", "tick"}));
}

TEST(TickUnderWatch, TripsAClockJumpInTheFirstTickAfterASuspension) {
  hal::PowerCut cut;
  Asked asked{cut, {}};
  for (const bool suspended : {false, true, false}) drive::tick_under_watch(asked, asked, cut, false, suspended);
  EXPECT_EQ(asked.order, (std::vector<std::string>{"tick", "clock jump", "tick", "tick"}));
}

}  // namespace
}  // namespace stiction::test
