// The drives in health: they switch on, follow circles without a false alarm, stop, home.
#include "hal/drive_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "firmware/machine/file/drive_file.hpp"
#include "sim/experiment/commissioning_path.hpp"
#include "tests/support/drive_bench.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/loop_cost.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

static_assert(hal::WiredBackend<hal::FaultyBackend<hal::SimulatedBackend<S>>>);
static_assert(hal::BrakeBackend<hal::FaultyBackend<hal::SimulatedBackend<S>>>);
static_assert(!hal::WiredBackend<hal::SimulatedBackend<S>>);

machine::Machine table(const std::string& noise = "5 nm") {
  return cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=" + noise});
}

class CircleInHealth : public ::testing::TestWithParam<std::tuple<double, std::string>> {};

TEST_P(CircleInHealth, GivesNoFault) {
  const auto [feed, noise] = GetParam();
  const auto machine = table(noise);
  DriveBench<> bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  bench.move({.feed = feed / 60.0});
  const double lap = 2.0 * 3.14159265 * 0.09 / (feed / 60.0);
  bench.run(static_cast<int>(std::min(1.3 * lap, 3.0 + lap) / bench.period));
  EXPECT_TRUE(bench.events.empty()) << name_of(bench.events.front().event.fault);
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
}

INSTANTIATE_TEST_SUITE_P(DriveLoop, CircleInHealth,
                         ::testing::Combine(::testing::Values(3.2, 8.0, 16.0, 24.0, 48.0),
                                            ::testing::Values("0 nm", "5 nm", "50 nm")));

// What stands around the cascade changes nothing in health: from the first tick under power on the drives' signals are
// those of the bare control loop that starts there.
TEST(DriveLoop, MovesTheCircleToTheBitAsTheControlLoopAlone) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated"});
  DriveBench<> bench(machine, drive_setup(machine));
  while (!bench.loop.all_in(DriveState::switched_on)) bench.want = DriveBench<>::Want::on, bench.tick();
  // A slow tick is the first under power, as in the loop alone. Until then the drives wait.
  for (std::size_t k = 0; k < 2; ++k) bench.override_word[k] = controlword::switch_on;
  while (!bench.loop.loop().slow()) bench.tick();
  bench.override_word = {};
  bench.hold_here();
  bench.move({.feed = 0.4});

  hal::SimulatedBackend<S> alone(machine, std::array{0.09, 0.0});
  const auto configs = configurations<S>(machine);
  hal::ControlLoop loop(alone, std::span<const AxisConfig<S>>(configs), ticker_of(machine));
  for (int i = 0; i < 16000; ++i) {
    const auto set = bench.next_set_points();
    bench.tick();
    loop.tick(set);
    ASSERT_EQ(raw_words(std::vector(bench.loop.loop().signals().begin(), bench.loop.loop().signals().end())),
              raw_words(std::vector(loop.signals().begin(), loop.signals().end())))
        << "tick " << i;
  }
}

TEST(DriveLoop, GivesNoFaultWithMotorsOfOnePhase) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated", "axis.*.motor.model=dc"});
  DriveBench<> bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  bench.move({.feed = 0.8});
  bench.run(16000);
  EXPECT_TRUE(bench.events.empty());
}

// A ball-screw axis with another period, a force source and an encoder of 50 nm: constant speeds both ways.
TEST(DriveLoop, GivesNoFaultOnTheBallScrewAxis) {
  const auto machine = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml", {});
  hal::SimulatedBackend<S> backend(machine, std::array{0.0});
  const auto drives = machine::configure_drives<S>(machine, drive_setup(machine));
  const auto configs = configurations<S>(machine);
  hal::DriveLoop loop(backend, std::span<const AxisConfig<S>>(configs), std::span<const ServoDriveConfig<S>>(drives),
                      ticker_of(machine));
  std::array<SetPoint<S>, 1> set{};
  for (int i = 0; i < 200; ++i) {
    loop.set_controlword(0, controlword_to_enable(loop.state(0)));
    loop.tick(set);
  }
  ASSERT_EQ(loop.state(0), DriveState::operation_enabled);
  const auto motion = sim::constant_speeds({0.02, 0.1, 0.15}, 0.5, 0.01);
  for (int i = 0; i < static_cast<int>(motion.duration / machine.timing.fast_period); ++i) {
    set[0] = sim::to_set_point<S>(motion.at((i + 1) * machine.timing.fast_period));
    loop.tick(set);
    ASSERT_EQ(loop.fault(0), Fault::none) << name_of(loop.fault(0)) << " at tick " << i;
  }
}

// The same axis in a loop of 10 ms, as over Modbus: from one sample to the next it moves by 0.1 mm more or less than
// the speed predicts where it accelerates by 1 m/s^2, which is no jump of its encoder.
TEST(DriveLoop, TakesNoAccelerationForAJumpOfTheEncoderInASlowLoop) {
  const std::string file = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml";
  const machine::ReadOptions slow{
      "",
      {"timing.fast_period=10 ms", "timing.slow_period=10 ms", "axis.X.max_velocity=0.04 m/s",
       "axis.X.velocity_controller.gain=30 V s/m", "axis.X.position_controller.gain=3 1/s",
       "axis.X.supervision.following_error=20 mm"}};
  const auto machine = sim::read_machine(file, slow);
  hal::SimulatedBackend<S> backend(machine, std::array{0.0});
  const auto drives = machine::configure_drives<S>(machine, machine::read_drive_setup(file, machine, slow));
  const auto configs = configurations<S>(machine);
  hal::DriveLoop loop(backend, std::span<const AxisConfig<S>>(configs), std::span<const ServoDriveConfig<S>>(drives),
                      ticker_of(machine));
  std::array<SetPoint<S>, 1> set{};
  for (int i = 0; i < 100; ++i) {
    loop.set_controlword(0, controlword_to_enable(loop.state(0)));
    loop.tick(set);
  }
  ASSERT_EQ(loop.state(0), DriveState::operation_enabled) << name_of(loop.fault(0));
  const auto motion = sim::constant_speeds({0.02}, 0.5, 0.04);
  for (int i = 0; i < static_cast<int>(motion.duration / machine.timing.fast_period); ++i) {
    set[0] = sim::to_set_point<S>(motion.at((i + 1) * machine.timing.fast_period));
    loop.tick(set);
    ASSERT_EQ(loop.fault(0), Fault::none) << name_of(loop.fault(0)) << " at tick " << i;
  }
}

// No allocation in a tick, with faults, stops and events in it.
TEST(DriveLoop, AllocatesNothingAfterItsConstruction) {
#ifdef STICTION_SANITIZED
  GTEST_SKIP() << "the sanitizer's allocator";
#endif
  const auto machine = table();
  DriveBench<> bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  std::array<SetPoint<S>, 2> set{};
  auto& loop = bench.loop;
  for (std::size_t k = 0; k < 2; ++k) set[k].position = loop.drive(k).position();
  const auto cost = memory_cost([&] {
    for (int i = 0; i < 8000; ++i) {
      if (i == 1000) bench.backend.faults(0).foreign_frames = 3;
      if (i == 1200) bench.backend.faults(0).encoder_open = true;
      if (i == 6000) bench.backend.faults(0) = {};
      for (std::size_t k = 0; k < 2; ++k) loop.set_controlword(k, controlword_to_enable(loop.state(k), i % 2 == 0));
      loop.tick(set);
    }
  });
  EXPECT_EQ(cost.allocator_calls, 0u);
  figure("allocations in 8000 ticks of two drives with two faults", fmt::format("{}", cost.allocator_calls));
}

// An offset of two sensors that cancels in the sum shows before the power comes.
TEST(DriveLoop, FindsACurrentOffsetOfEachPhaseWithThePowerOff) {
  const auto machine = table();
  DriveBench<> bench(machine, drive_setup(machine));
  bench.backend.faults(0).current_offset = {5.0, -5.0, 0.0};
  EXPECT_FALSE(bench.enable());
  EXPECT_EQ(bench.loop.fault(0), Fault::current_offset);
  EXPECT_EQ(bench.loop.state(0), DriveState::fault);
  EXPECT_FALSE(bench.powered(1));
}

TEST(DriveLoop, EnablesNothingWithADamagedParameterFile) {
  const auto machine = table();
  DriveBench<> bench(machine, drive_setup(machine));
  bench.before_tick = [&] { bench.loop.trip(Fault::parameters_damaged); };
  EXPECT_FALSE(bench.enable());
  EXPECT_TRUE(bench.loop.all_in(DriveState::fault));
  EXPECT_FALSE(bench.reset());
}

// A flipped bit of less than encoder_jump moves the position by its weight at most, which nothing here can see as a
// jump; the checksum of a frame can, where there is one. From 1 um on its edges drive the current to and fro between
// its limits.
TEST(DriveLoop, SeesEachFlippedBitThatMovesTheCarriageByMoreThanAMicrometre) {
  const auto machine = table();
  double worst_unseen = 0.0;
  int highest_unseen = -1;
  for (int bit = 0; bit <= 40; ++bit) {
    DriveBench<> bench(machine, drive_setup(machine));
    ASSERT_TRUE(bench.enable());
    bench.move({.feed = 0.4});
    bench.run(8000);
    bench.backend.faults(0).flipped_bit = bit;
    if (bit >= 13) {  // 8.2 um
      bench.run(2);
      EXPECT_EQ(bench.loop.fault(0), Fault::encoder_jump) << "bit " << bit;
      EXPECT_FALSE(bench.powered(0)) << "bit " << bit;
      continue;
    }
    double worst = 0.0;
    for (int i = 0; i < 22620; ++i) {  // a lap
      bench.tick();
      if (bench.powered(0))
        worst = std::max(
            worst, std::abs(machine::to_si(bench.next_set_points()[0].position) - bench.simulated.plant(0).position()));
    }
    if (!bench.events.empty()) continue;
    highest_unseen = bit;
    worst_unseen = std::max(worst_unseen, worst);
  }
  EXPECT_LT(highest_unseen, 10);
  EXPECT_LT(worst_unseen, 15e-6);  // the circle's own error is 10 um at this feed
  figure("flipped bits of a 1 nm encoder with encoder_jump 5 um",
         fmt::format("{} to 40 seen, from 13 on in the same tick; below {:.1f} um off the path at most",
                     highest_unseen + 1, worst_unseen * 1e6));
}

TEST(DriveLoop, BearsOneMissedTickAndCountsIt) {
  const auto machine = table();
  DriveBench<> bench(machine, drive_setup(machine));
  ASSERT_TRUE(bench.enable());
  bench.move({.feed = 0.4});
  bench.run(4000);
  for (int i = 0; i < 50; ++i) {
    bench.backend.miss_ticks(1);
    bench.run(40);
  }
  EXPECT_TRUE(bench.events.empty()) << name_of(bench.events.front().event.fault);
  EXPECT_EQ(bench.loop.missed_ticks(), 50u);
}

TEST(DriveLoop, DropsEventsThatNobodyTakesAndCountsThem) {
  const auto machine = table();
  const auto setup = drive_setup(machine);
  DriveBench<> bench(machine, setup);
  using Loop = DriveBench<>::Loop;
  std::array<SetPoint<S>, 2> set{};
  auto& loop = bench.loop;
  for (int i = 0; i < 60; ++i) {
    for (std::size_t k = 0; k < 2; ++k) loop.set_controlword(k, 0);
    loop.trip(Fault::watchdog_starved);
    for (int t = 0; t < 4; ++t) loop.tick(set);
    for (std::size_t k = 0; k < 2; ++k) loop.set_controlword(k, controlword::fault_reset);
    for (int t = 0; t < 4; ++t) loop.tick(set);
    EXPECT_FALSE(loop.faulted());
  }
  EXPECT_EQ(loop.dropped_events(), 2u * 60u - Loop::event_capacity);
  hal::AxisEvent<S> event;
  std::size_t taken = 0;
  while (loop.next_event(event)) ++taken;
  EXPECT_EQ(taken, Loop::event_capacity);
}

}  // namespace
}  // namespace stiction::test
