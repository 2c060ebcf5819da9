// Edges of the pulse for a watchdog outside of the computer.
#include "hal/gpio/watchdog_pulse.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace stiction::test {
namespace {

constexpr std::int64_t tick_ns = 62'500, period_ns = 1'000'000;

// Times of the edges between two times, with a tick every 62.5 us.
std::vector<std::int64_t> edges(hal::WatchdogPulse& pulse, std::int64_t begin_ns, std::int64_t end_ns) {
  std::vector<std::int64_t> found;
  bool level = pulse.step(begin_ns);
  for (std::int64_t now_ns = begin_ns + tick_ns; now_ns < end_ns; now_ns += tick_ns)
    if (const bool next = pulse.step(now_ns); next != level) {
      found.push_back(now_ns);
      level = next;
    }
  return found;
}

TEST(WatchdogPulse, ChangesItsLevelOnceAPeriodWhileTheLoopGoesOn) {
  hal::WatchdogPulse pulse(period_ns);
  const auto found = edges(pulse, 5'000'000, 105'000'000);
  ASSERT_EQ(found.size(), 99u);
  for (std::size_t i = 1; i < found.size(); ++i) EXPECT_EQ(found[i] - found[i - 1], period_ns);
}

TEST(WatchdogPulse, DoesNotMakeUpForEdgesThatALoopWhichStoodStillHasMissed) {
  hal::WatchdogPulse pulse(period_ns);
  const auto before = edges(pulse, 5'000'000, 10'000'000);
  const auto after = edges(pulse, 300'000'000, 305'000'000);
  ASSERT_FALSE(before.empty());
  for (std::size_t i = 1; i < after.size(); ++i) EXPECT_GE(after[i] - after[i - 1], period_ns);
  EXPECT_LE(after.size(), 5u);
}

TEST(WatchdogPulse, OfAPeriodBelowATickChangesInEachTick) {
  hal::WatchdogPulse pulse(1);
  EXPECT_EQ(edges(pulse, 5'000'000, 6'000'000).size(), 15u);
}

}  // namespace
}  // namespace stiction::test
