// The start of a drive's loop on the kernel's time, which goes on while the programme prepares: between the loop's
// construction and its first tick pages are locked, threads are made and a processor is taken.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <span>

#include "firmware/machine/configuration/drive_configuration.hpp"
#include "hal/drive_loop.hpp"
#include "hal/loop_timing.hpp"
#include "hal/paced_backend.hpp"
#include "hal/simulated/faulty_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "tests/hal/fake_time.hpp"
#include "tests/support/drive_bench.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;
using Simulated = hal::SimulatedBackend<S>;
using Faulty = hal::FaultyBackend<Simulated>;
constexpr std::int64_t period_ns = 62'500;

// The simulated machine at the end of wires, as those of CAN, Modbus and GPIO: ticks and samples have the kernel's
// time.
class Wired {
 public:
  using Signals = S;

  Wired(Faulty& world, std::int64_t period, FakeTime time) : world_(world), clock_(period, time) {}

  std::size_t axis_count() const { return world_.axis_count(); }
  void begin() { clock_.restart(); }
  std::int64_t wait_for_tick() {
    now_ns_ = clock_.wait();
    world_ns_ = world_.wait_for_tick();
    return now_ns_;
  }
  void read(std::span<Feedback<S>> feedback) {
    world_.read(feedback);
    for (auto& f : feedback) f.position_time_ns += now_ns_ - world_ns_;
  }
  void write(std::span<const Command<S>> command) { world_.write(command); }
  void read_inputs(std::span<DigitalInputs<S>> inputs) { world_.read_inputs(inputs); }
  Fault fault(std::size_t axis) { return world_.fault(axis); }
  hal::BasicTickClock<FakeTime>& clock() { return clock_; }

 private:
  Faulty& world_;
  hal::BasicTickClock<FakeTime> clock_;
  std::int64_t now_ns_ = 0, world_ns_ = 0;
};

using Paced = hal::PacedBackend<Faulty, FakeTime>;
static_assert(hal::KernelTimeBackend<Paced> && hal::KernelTimeBackend<hal::TimedBackend<Paced, FakeTime>>);
static_assert(hal::KernelTimeBackend<Wired>);
static_assert(!hal::KernelTimeBackend<Simulated> && !hal::KernelTimeBackend<hal::TimedBackend<Simulated>>);

// From a third of a period to what the watch takes for a jump of the clock, and beyond.
constexpr std::array<std::int64_t, 7> preparations_ns{20'000,     4 * period_ns, 4'700'000,    23'000'000,
                                                      99'000'000, 101'000'000,   5'000'000'000};

// As firmware/stictiond/run.hpp puts them together.
template <class B>
struct Start {
  using Timed = hal::TimedBackend<B, FakeTime>;

  machine::Machine machine = cross_table({"axis.*.encoder.velocity=estimated"});
  FakeClock time;
  Simulated simulated{machine, std::array{0.09, 0.0}};
  Faulty world{simulated, period_ns, machine.axes[0].encoder.increment};
  B backend{world, period_ns, {&time}};
  hal::BasicLoopTiming<FakeTime> timing{{&time}};
  Timed timed{backend, timing};
  hal::DriveLoop<Timed> loop{timed, configurations<S>(machine),
                             machine::configure_drives<S>(machine, drive_setup(machine)), ticker_of(machine)};

  void tick() {
    std::array<SetPoint<S>, 2> sets;
    for (std::size_t i = 0; i < sets.size(); ++i) {
      loop.set_controlword(i, controlword_to_enable(loop.state(i)));
      sets[i].position = loop.drive(i).set_position();
    }
    loop.tick(sets);
  }
};

template <class B>
class LoopStart : public ::testing::Test {};
using BackendsInKernelTime = ::testing::Types<Paced, Wired>;
TYPED_TEST_SUITE(LoopStart, BackendsInKernelTime);

TYPED_TEST(LoopStart, TakesNoPreparationForLateness) {
  for (const auto preparation_ns : preparations_ns) {
    SCOPED_TRACE(preparation_ns);
    Start<TypeParam> s;
    s.time.now_ns += preparation_ns;
    s.loop.begin();
    for (int i = 0; i < 1600 && !s.loop.all_in(DriveState::operation_enabled); ++i) {
      s.tick();
      ASSERT_EQ(s.loop.fault(0), Fault::none) << name_of(s.loop.fault(0)) << " at tick " << i;
    }
    EXPECT_TRUE(s.loop.all_in(DriveState::operation_enabled));
  }
}

TYPED_TEST(LoopStart, KeepsThePreparationOutOfTheFiguresOfTheLoop) {
  for (const auto preparation_ns : preparations_ns) {
    SCOPED_TRACE(preparation_ns);
    Start<TypeParam> s;
    s.backend.wait_for_tick();  // as a backend that looks for its nodes does
    s.time.now_ns += preparation_ns;
    s.backend.wait_for_tick();
    s.time.now_ns += preparation_ns;
    s.loop.begin();
    for (int i = 0; i < 99; ++i) s.tick();
    const auto& clock = s.backend.clock();
    EXPECT_EQ(clock.missed(), 0u);
    EXPECT_EQ(clock.jumps(), 0u);
    EXPECT_EQ(s.loop.missed_ticks(), 0u);
    EXPECT_EQ(clock.lateness().read().total, 100u);
    EXPECT_EQ(clock.lateness().read().maximum, 0);
    EXPECT_EQ(s.timing.part(hal::LoopPart::wait).read().total, 100u);
    EXPECT_EQ(s.timing.part(hal::LoopPart::wait).read().maximum, period_ns);
  }
}

// What is late after the first tick is late.
TYPED_TEST(LoopStart, WatchesFromTheFirstTickOn) {
  Start<TypeParam> s;
  s.time.now_ns += 4'700'000;
  s.loop.begin();
  s.tick();
  s.time.now_ns += 4 * period_ns;
  s.tick();
  s.tick();
  EXPECT_EQ(s.loop.fault(0), Fault::missed_deadline);
}

// The axes coast while the programme prepares: what the encoder shows then is neither a jump nor a place to go back to.
TYPED_TEST(LoopStart, TakesTheAxesWhereTheyAreAtItsFirstTick) {
  Start<TypeParam> s;
  const auto before = s.loop.drive(0).position();
  s.world.faults(0).encoder_shift = 0.002;
  s.time.now_ns += 4'700'000;
  s.loop.begin();
  EXPECT_NEAR(machine::to_si(s.loop.drive(0).position() - before), 0.002, 1e-6);
  for (int i = 0; i < 1600; ++i) s.tick();
  EXPECT_EQ(s.loop.fault(0), Fault::none) << name_of(s.loop.fault(0));
  EXPECT_TRUE(s.loop.all_in(DriveState::operation_enabled));
}

}  // namespace
}  // namespace stiction::test
