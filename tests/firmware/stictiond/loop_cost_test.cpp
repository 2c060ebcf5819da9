// What the loop's body costs beyond processor time: it neither allocates nor faults a page nor calls the kernel, but
// for what its backend does. Under a sanitizer, which has an allocator of its own, the counts mean nothing.
#include "tests/support/loop_cost.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "firmware/stictiond/log_ring.hpp"
#include "firmware/stictiond/real_time.hpp"
#include "hal/control_loop.hpp"
#include "hal/loop_timing.hpp"
#include "hal/paced_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/closed_loop.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
using Simulated = hal::SimulatedBackend<S>;
using Paced = hal::PacedBackend<Simulated>;

constexpr std::array<double, 2> start{0.09, 0.0};
constexpr int ticks = 16'000;  // a second

// The cross table on its circle in the drive's loop, with its timing and with more to say than any drive has. Paced by
// the kernel's clock at the loop's own period, or in logical time.
template <class World>
class Drive {
 public:
  explicit Drive(World& world)
      : timed_(world, *timing_), loop_(timed_, std::span<const AxisConfig<S>>(configs_), ticker_of(machine_)) {}

  void run(int count) {
    for (int i = 0; i < count; ++i) {
      const auto point = path_.at(static_cast<double>(loop_.now_ns() - begin_ns_) * 1e-9);
      const std::array set{sim::to_set_point<S>(point.axes[0]), sim::to_set_point<S>(point.axes[1])};
      timing_->lap(hal::LoopPart::set_point);
      loop_.tick(set);
      ring_->push(loop_.now_ns(), drive::LogLevel::info, "tick {}: {}", {i, "fault"});
      timing_->lap(hal::LoopPart::trace);
    }
  }

  bool faulted() const { return loop_.faulted(); }

 private:
  machine::Machine machine_ = cross_table();
  sim::CirclePath path_{{.feed = 0.4}};
  std::vector<AxisConfig<S>> configs_ = configurations<S>(machine_);
  std::unique_ptr<hal::LoopTiming> timing_ = std::make_unique<hal::LoopTiming>();
  std::unique_ptr<drive::LogRing> ring_ = std::make_unique<drive::LogRing>();
  hal::TimedBackend<World> timed_;
  hal::ControlLoop<hal::TimedBackend<World>> loop_;
  std::int64_t begin_ns_ = loop_.now_ns();
};

TEST(LoopCost, CountsWhatIsThere) {
#ifdef STICTION_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator";
#endif
  const auto cost = memory_cost([] { *std::make_unique<volatile int>() = 1; });
  EXPECT_EQ(cost.allocator_calls, 2u);
  const auto calls = system_calls([] { return [] { ::getppid(); }; });
  EXPECT_EQ(calls, (std::map<long, std::uint64_t>{{SYS_getppid, 1}}));
}

TEST(LoopCost, TheLoopAllocatesNothingAndFaultsNoPage) {
#ifdef STICTION_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator";
#endif
  Simulated world(cross_table(), start);
  Drive<Simulated> drive(world);
  drive.run(ticks);
  // A page that the kernel took for others meanwhile is not the loop's fault; one that the loop asks for comes back.
  auto cost = memory_cost([&] { drive.run(ticks); });
  for (int again = 0; again < 4 && cost.minor_faults + cost.major_faults > 0; ++again)
    cost = memory_cost([&] { drive.run(ticks); });
  ASSERT_FALSE(drive.faulted());
  EXPECT_EQ(cost.allocator_calls, 0u);
  EXPECT_EQ(cost.minor_faults, 0);
  EXPECT_EQ(cost.major_faults, 0);
  figure("allocations and page faults of the loop in 16 000 ticks",
         fmt::format("{} and {} (bound 0)", cost.allocator_calls, cost.minor_faults + cost.major_faults));
}

TEST(LoopCost, TheLoopCallsTheKernelOnlyToSleep) {
#ifdef STICTION_SANITIZED
  GTEST_SKIP() << "the sanitizer's own calls";
#endif
  struct PacedDrive {
    Simulated simulated{cross_table(), start};
    // Slow enough that a traced tick on a busy machine is seldom late; a late one counts no call more.
    Paced world{simulated, 250'000};
    Drive<Paced> drive{world};
  };
  constexpr int traced_ticks = 2000;
  const auto calls = system_calls([] {
    const auto loop = std::make_shared<PacedDrive>();
    loop->drive.run(100);
    return [loop] { loop->drive.run(traced_ticks); };
  });
  std::uint64_t others = 0;
  for (const auto& [number, count] : calls)
    if (number != SYS_clock_nanosleep) others += count;
  const auto sleeps = calls.contains(SYS_clock_nanosleep) ? calls.at(SYS_clock_nanosleep) : 0;
  EXPECT_GT(sleeps, 0u);
  EXPECT_LE(sleeps, static_cast<std::uint64_t>(traced_ticks));  // none after a stall that counts as a clock jump
  EXPECT_EQ(others, 0u) << "the first is number " << calls.begin()->first;
  figure("system calls of the loop in 2000 ticks beyond one sleep a tick", fmt::format("{} (bound 0)", others));
}

}  // namespace
}  // namespace stiction::test
