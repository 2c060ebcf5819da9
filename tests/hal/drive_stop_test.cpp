// How drives stop: on command, by a fault on the way, with a brake, against a disturbance that does not let them rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "tests/hal/fault_cases.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using hal::FrameFault;
using hal::SwitchFault;

constexpr double feed = 24.0 / 60.0;   // m/s
constexpr double deceleration = 10.0;  // m/s^2

machine::Machine table() { return cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=5 nm"}); }

Bench moving_bench(const std::function<void(machine::DriveAxisSetup&)>& change = {},
                   const std::function<void(ServoDriveConfig<FixedSignals>&)>& configure = {}) {
  const auto machine = table();
  auto setup = drive_setup(machine);
  if (change)
    for (auto& [name, axis] : setup.axes) change(axis);
  auto drives = machine::configure_drives<FixedSignals>(machine, setup);
  if (configure)
    for (auto& drive : drives) configure(drive);
  Bench bench(machine, drives);
  EXPECT_TRUE(bench.enable());
  bench.move({.feed = feed});
  bench.run(9000);
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
  return bench;
}

double speed(Bench& bench, std::size_t axis) { return std::abs(bench.simulated.plant(axis).velocity()); }

TEST(DriveStop, OnCommandTakesTheTimeOfItsDecelerationAndEndsWithoutPower) {
  auto bench = moving_bench();
  const std::array v{speed(bench, 0), speed(bench, 1)};
  const std::array x{bench.simulated.plant(0).position(), bench.simulated.plant(1).position()};
  bench.want = Bench::Want::quick_stop;
  std::array<int, 2> ticks{};
  for (int i = 0; i < 4000; ++i) {
    bench.tick();
    for (std::size_t k = 0; k < 2; ++k) {
      if (bench.powered(k)) {
        EXPECT_EQ(bench.loop.state(k), DriveState::quick_stop_active);
        ++ticks[k];
      }
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    // The ramp, a following error that settles within 30 ms, and 10 ms of standstill.
    EXPECT_GE(ticks[k] * bench.period, v[k] / deceleration);
    EXPECT_LE(ticks[k] * bench.period, v[k] / deceleration + 0.041);
    EXPECT_NEAR(std::abs(bench.simulated.plant(k).position() - x[k]), v[k] * v[k] / (2.0 * deceleration), 0.2e-3);
    EXPECT_EQ(bench.loop.state(k), DriveState::switch_on_disabled);
  }
  EXPECT_TRUE(bench.events.empty());
}

TEST(DriveStop, IsHeldUnderPowerWhereTheOptionSaysSoAndGoesOnFromThere) {
  auto bench = moving_bench({}, [](auto& drive) { drive.stops.quick_stop = 6; });
  bench.want = Bench::Want::quick_stop;
  bench.run(8000);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(bench.loop.state(k), DriveState::quick_stop_active);
    EXPECT_TRUE(bench.powered(k));
  }
  bench.hold_here();
  for (std::size_t k = 0; k < 2; ++k) bench.override_word[k] = controlword::enable_operation;
  bench.run(2);
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
  bench.move({.feed = 0.1});
  bench.run(8000);
  EXPECT_TRUE(bench.events.empty());
  EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));
}

TEST(DriveStop, IsMadeBeforeOperationIsDisabledAndFinishedThoughItIsEnabledAgainMeanwhile) {
  for (const std::uint16_t word : {controlword::shutdown, controlword::switch_on}) {
    auto bench = moving_bench();
    for (std::size_t k = 0; k < 2; ++k) bench.override_word[k] = word;
    bench.run(50);  // 3 ms
    for (std::size_t k = 0; k < 2; ++k) bench.override_word[k] = controlword::enable_operation;
    bool rested = false;
    double fastest_without_power = 0.0;
    for (int i = 0; i < 3000; ++i) {
      bench.hold_here();
      bench.tick();
      for (std::size_t k = 0; k < 2; ++k)
        if (!bench.powered(k)) {
          rested = true;
          fastest_without_power = std::max(fastest_without_power, speed(bench, k));
        }
    }
    EXPECT_TRUE(rested);
    EXPECT_LT(fastest_without_power, 2e-3);                         // standstill is 1 mm/s measured
    EXPECT_TRUE(bench.loop.all_in(DriveState::operation_enabled));  // again, at rest
    EXPECT_TRUE(bench.events.empty());
  }
}

TEST(DriveStop, IsNotMadeWhenTheVoltageIsDisabled) {
  auto bench = moving_bench();
  bench.want = Bench::Want::off;
  bench.tick();
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_FALSE(bench.powered(k));
    EXPECT_EQ(bench.loop.state(k), DriveState::switch_on_disabled);
  }
}

// A push to and fro that this loop cannot hold still: 15 mm/s.
TEST(DriveStop, ThatDoesNotEndTakesThePowerOffAfterItsMargin) {
  auto bench = moving_bench();
  const double v = speed(bench, 0);
  bench.want = Bench::Want::quick_stop;
  int powered = 0, tick = 0;
  bench.before_tick = [&] {
    bench.simulated.plant(0).set_external_force(1.2e3 * std::sin(2.0 * 3.14159265 * 40.0 * ++tick * bench.period));
  };
  for (int i = 0; i < 16000 && bench.powered(0); ++i) {
    bench.tick();
    ++powered;
  }
  bench.before_tick = nullptr;
  EXPECT_NEAR(powered * bench.period, v / deceleration + 0.1, 2.0 * bench.period);
  EXPECT_EQ(bench.loop.fault(0), Fault::none);
}

struct Pair {
  const char* name;
  Fault first;
  std::function<void(Bench&)> begin;
  Fault second;
  std::function<void(Bench&)> then;
};

// Each fault that is answered by a stop, with one on top of it.
std::vector<Pair> pairs() {
  const auto late_frames = [](Bench& b) {
    b.backend.faults(0).frame = FrameFault::twice;
    b.backend.faults(0).frame_period = 5;
  };
  const auto stuck = [](Bench& b) { b.backend.faults(0).positive_switch = SwitchFault::stuck_closed; };
  const auto babble = [](Bench& b) { b.backend.faults(0).foreign_frames = 3; };
  const auto open = [](Bench& b) { b.backend.faults(0).encoder_open = true; };
  const auto jump = [](Bench& b) { b.backend.faults(0).encoder_shift = 1e-3; };
  const auto offset = [](Bench& b) { b.backend.faults(0).current_offset[0] = 10.0; };
  const auto stage = [](Bench& b) { b.backend.faults(0).power_stage = true; };
  const auto off = [](Bench& b) { b.backend.faults(0).bus_off = true; };
  return {
      {"disturbed frames, then an open encoder", Fault::frames_disturbed, late_frames, Fault::position_lost, open},
      {"a stuck switch, then a jump", Fault::limit_switch_stuck, stuck, Fault::encoder_jump, jump},
      {"a babbling node, then an offset", Fault::bus_overload, babble, Fault::current_offset, offset},
      {"a stuck switch, then the power stage", Fault::limit_switch_stuck, stuck, Fault::drive_input, stage},
      {"a babbling node, then bus off", Fault::bus_overload, babble, Fault::bus_off, off},
      {"a stuck switch, then another stop's fault", Fault::limit_switch_stuck, stuck, Fault::bus_overload, babble},
  };
}

TEST(DriveStop, OfAFaultEndsAtOnceWithASecondOneAndBothAreOnRecord) {
  for (const auto& pair : pairs()) {
    SCOPED_TRACE(pair.name);
    auto bench = moving_bench();
    pair.begin(bench);
    for (int i = 0; i < 2000 && bench.loop.fault(0) == Fault::none; ++i) bench.tick();
    ASSERT_EQ(bench.loop.fault(0), pair.first);
    ASSERT_TRUE(bench.powered(0));
    bench.run(20);
    EXPECT_EQ(bench.loop.state(0), DriveState::fault_reaction_active);
    EXPECT_EQ(bench.loop.state(1), DriveState::quick_stop_active);
    const double v = speed(bench, 0);
    EXPECT_GT(v, 0.05);  // still on its way
    pair.then(bench);
    const int allowed = description_of(pair.second)->detection_ticks;
    bench.run(allowed + 1);  // what is broken now shows in the next tick
    EXPECT_FALSE(bench.powered(0));
    EXPECT_EQ(bench.loop.fault(0), pair.first);
    ASSERT_EQ(bench.events.size(), 2u);
    EXPECT_EQ(bench.events[0].event.fault, pair.first);
    EXPECT_FALSE(bench.events[0].event.following);
    EXPECT_EQ(bench.events[1].event.fault, pair.second);
    EXPECT_TRUE(bench.events[1].event.following);
    EXPECT_EQ(bench.events[1].axis, 0u);
    EXPECT_TRUE(bench.powered(1));  // the other axis ends its own stop
    bench.run(40000);
    EXPECT_FALSE(bench.powered(1));
    EXPECT_EQ(bench.loop.state(0), DriveState::fault);
  }
}

TEST(DriveStop, OfOneAxisStopsTheOtherByItsOwnRampAndKeepsItOffUntilTheReset) {
  auto bench = moving_bench();
  bench.backend.faults(0).encoder_open = true;
  for (int i = 0; i < 10 && bench.loop.fault(0) == Fault::none; ++i) bench.tick();
  const double v = speed(bench, 1), x = bench.simulated.plant(1).position();
  bench.tick();
  EXPECT_EQ(bench.loop.state(1), DriveState::quick_stop_active);
  bench.run(8000);
  EXPECT_EQ(bench.loop.state(1), DriveState::switch_on_disabled);
  EXPECT_EQ(bench.loop.fault(1), Fault::none);
  EXPECT_NEAR(std::abs(bench.simulated.plant(1).position() - x), v * v / (2.0 * deceleration), 0.3e-3);
  bench.run(4000);  // asked to enable all the time
  EXPECT_FALSE(bench.powered(1));
  bench.backend.faults(0).encoder_open = false;
  bench.run(10);
  EXPECT_TRUE(bench.reset());
  EXPECT_TRUE(bench.enable());
}

TEST(DriveStop, IsNoneForAFaultThatTheTableDoesNotHave) {
  auto bench = moving_bench();
  bench.loop.trip(0, static_cast<Fault>(200));
  bench.tick();
  EXPECT_FALSE(bench.powered(0));
}

// The wrong force brakes first, which is no runaway yet, as an obstacle does the same: one of two rows sees it,
// whichever comes first. No ramp stops such an axis, as its force drives the error up: the power goes with the window,
// 2 mm, and not behind a stop. What the set-point goes in a tick is on top of it: 25 um.
TEST(DriveStop, FollowsAMotorOfTheWrongSignInMotionBeforeItRunsAway) {
  double way = 0.0, time = 0.0;
  std::array<int, 2> seen{};
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (int moment = 0; moment < 16; ++moment) {
      auto bench = moving_bench();
      bench.run(moment * 1414);
      bench.backend.faults(axis).motor_reversed = true;
      const double x = bench.simulated.plant(axis).position();
      const auto target = [&] { return machine::to_si(bench.next_set_points()[axis].position); };
      int ticks = 0;
      double apart = 0.0;
      for (; ticks < 8000 && bench.powered(axis); ++ticks) {
        const bool stopping = bench.loop.fault(axis) != Fault::none;
        const double set = stopping ? machine::to_si(bench.loop.drive(axis).set_position()) : target();
        apart = std::max(apart, std::abs(set - bench.simulated.plant(axis).position()));
        bench.tick();
      }
      const auto fault = bench.loop.fault(axis);
      EXPECT_TRUE(fault == Fault::runaway || fault == Fault::following_error) << name_of(fault);
      EXPECT_FALSE(bench.powered(axis));
      ++seen[fault == Fault::runaway ? 0 : 1];
      way = std::max(way, apart);
      time = std::max(time, ticks * bench.period);
      EXPECT_NE(x, 0.0);
    }
  EXPECT_LT(way, 2e-3 + 0.4 * 62.5e-6 + 1e-6);
  figure("motor of the wrong sign in motion at 24 m/min, 32 moments",
         fmt::format("{} as runaway, {} as following error; at most {:.1f} ms and {:.2f} mm off the path", seen[0],
                     seen[1], time * 1e3, way * 1e3));
}

TEST(DriveStop, ClosesTheBrakeBeforeThePowerGoesAndOpensItBehindIt) {
  constexpr double brake = 0.05;  // s
  auto bench = moving_bench([](auto& axis) { axis.brake_time = 0.05; });
  bench.want = Bench::Want::quick_stop;
  int closed_under_power = 0;
  for (int i = 0; i < 8000; ++i) {
    bench.tick();
    const bool released = bench.backend.brake_released(0);
    if (bench.powered(0) && !released) ++closed_under_power;
    EXPECT_FALSE(released && !bench.powered(0));
    // Without power the bristles push the carriage, which has no brake here, by up to 0.1 mm.
    EXPECT_FALSE(bench.powered(0) && !released && speed(bench, 0) > 2e-3);
  }
  EXPECT_NEAR(closed_under_power * bench.period, brake, 2.0 * bench.period);
  EXPECT_FALSE(bench.powered(0));

  ASSERT_TRUE(bench.enable());
  EXPECT_TRUE(bench.backend.brake_released(0));
  EXPECT_EQ(bench.loop.statusword(0) & statusword::follows_bit, 0);  // it opens
  int opening = 0;
  for (; opening < 8000 && (bench.loop.statusword(0) & statusword::follows_bit) == 0; ++opening) {
    bench.hold_here();
    bench.tick();
  }
  EXPECT_NEAR(opening * bench.period, brake, 2.0 * bench.period);
}

TEST(DriveStop, ClosesTheBrakeAtOnceWhereAFaultTakesThePower) {
  auto bench = moving_bench([](auto& axis) { axis.brake_time = 0.05; });
  bench.backend.faults(0).power_stage = true;
  bench.run(3);  // what breaks shows in the second tick; what the cascade sees the brake has in the next one
  EXPECT_FALSE(bench.powered(0));
  EXPECT_FALSE(bench.backend.brake_released(0));
}

}  // namespace
}  // namespace stiction::test
