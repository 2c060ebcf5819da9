// What an axis takes from a bus and what it refuses: references, ends of the travel, moves, offsets.
#include "stiction/drive/remote_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "tests/firmware/drive/asked_axis.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using enum DriveState;

TEST(References, WithoutThemAbsoluteMovesAreRefusedWithABitAndAReason) {
  auto a = enabled_in(OperationMode::profile_position, 0.0, HomingMethod::here);
  EXPECT_TRUE(a.shows(statusword::unreferenced_bit));
  offer(a, 0.1);
  EXPECT_FALSE(a.shows(statusword::acknowledge_bit));
  EXPECT_TRUE(a.shows(statusword::limit_bit));
  EXPECT_TRUE(a.shows(statusword::warning_bit));
  EXPECT_EQ(a.remote.refusal(), Refusal::no_reference);
  a.run(500);
  EXPECT_EQ(a.x, 0.0);
  // A relative one is taken, by any way: nothing says where the ends are.
  offer(a, 0.6, controlword::relative_bit);
  EXPECT_TRUE(a.shows(statusword::acknowledge_bit));
  EXPECT_EQ(a.remote.refusal(), Refusal::none);
  a.run(20'000);
  EXPECT_NEAR(a.x, 0.6, 1e-9);
}

TEST(References, WithoutThemCyclicTargetsAreRefusedAndTheAxisHolds) {
  auto a = enabled_in(OperationMode::cyclic_position, 0.0, HomingMethod::here);
  EXPECT_FALSE(a.shows(statusword::follows_bit));
  EXPECT_FALSE(a.shows(statusword::limit_bit)) << "a target where it stands asks for nothing";
  for (int i = 0; i < 500; ++i) {
    if (i % ServedAxis::cycle_ticks == 0) a.remote.offer(si<FixedSignals::Position>(0.01), true);
    a.step();
  }
  EXPECT_EQ(a.x, 0.0);
  EXPECT_TRUE(a.shows(statusword::limit_bit));
  EXPECT_EQ(a.remote.refusal(), Refusal::no_reference);
  a.remote.offer({}, false);
  a.run(ServedAxis::cycle_ticks);
  EXPECT_EQ(a.remote.refusal(), Refusal::no_reference);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  EXPECT_EQ(a.drive.state(), operation_enabled);
  home(a);
  a.remote.ask(OperationMode::cyclic_position);
  a.remote.ask(on_word);
  a.stream(32, 0.0);
  a.stream(2000, 0.1);
  EXPECT_TRUE(a.shows(statusword::follows_bit));
  EXPECT_GT(a.x, 5e-3);
}

// Each fault of the table that may take the encoder's place: refused again until it is homed again.
TEST(References, AreLostByEveryFaultThatTheTableSays) {
  int lost = 0, refused = 0;
  const auto refuses = [](ServedAxis& a) {
    offer(a, 0.1);
    return !a.shows(statusword::acknowledge_bit) && a.shows(statusword::limit_bit) &&
           a.shows(statusword::unreferenced_bit) && a.remote.refusal() == Refusal::no_reference;
  };
  auto never_homed = enabled_in(OperationMode::profile_position, 0.0, HomingMethod::here);
  const bool refused_at_first = refuses(never_homed);
  EXPECT_TRUE(refused_at_first);
  for (const auto& row : fault_table) {
    SCOPED_TRACE(row.name);
    auto a = enabled_in(OperationMode::homing, 0.0, HomingMethod::here);
    home(a);
    a.trip = row.fault;
    a.step();
    a.trip = Fault::none;
    EXPECT_EQ(a.drive.fault(), row.fault);
    a.remote.ask(controlword::disable_voltage);
    a.run(3000);
    a.remote.ask(controlword::fault_reset);
    a.run(2);
    ASSERT_EQ(a.drive.fault(), Fault::none);
    EXPECT_EQ(a.drive.referenced(), !row.loses_reference);
    lost += row.loses_reference ? 1 : 0;
    a.remote.ask(OperationMode::profile_position);
    ASSERT_TRUE(a.enable());
    a.stream(64, 0.0);
    const bool refused_here = refuses(a);
    refused += refused_here ? 1 : 0;
    EXPECT_EQ(refused_here, row.loses_reference);
    EXPECT_EQ(a.shows(statusword::acknowledge_bit), !row.loses_reference);
    EXPECT_EQ(a.remote.refusal(), row.loses_reference ? Refusal::no_reference : Refusal::none);
  }
  EXPECT_GE(lost, 4);
  figure(
      "absolute moves of an axis that was never homed, or lost its reference by a fault: refused with bit and reason",
      std::to_string(refused + (refused_at_first ? 1 : 0)) + " of " + std::to_string(lost + 1) + " (bound all)");
}

constexpr double beyond = end + 1e-6;

TEST(Ends, OneMicrometreBeyondThemAProfileMoveGoesBackAndNotOut) {
  for (const double side : {1.0, -1.0}) {
    auto a = enabled_in(OperationMode::profile_position, side * beyond);
    offer(a, side * (beyond + 1e-3));
    EXPECT_EQ(a.remote.refusal(), Refusal::beyond_end);
    EXPECT_TRUE(a.shows(statusword::limit_bit));
    offer(a, side * 0.4);
    EXPECT_EQ(a.remote.refusal(), Refusal::none);
    a.run(20'000);
    EXPECT_NEAR(a.x, side * 0.4, 1e-9);
    EXPECT_EQ(a.drive.fault(), Fault::none);
  }
}

TEST(Ends, OneMicrometreBeyondThemSpeedsGoBackAndNotOut) {
  for (const auto mode : {OperationMode::profile_velocity, OperationMode::cyclic_velocity})
    for (const double side : {1.0, -1.0}) {
      auto a = enabled_in(mode, side * beyond);
      a.stream(1000, side * 0.1);
      EXPECT_NEAR(a.x, side * beyond, 1e-9) << "not further out";
      EXPECT_TRUE(a.shows(statusword::limit_bit));
      a.stream(3000, side * -0.1);
      EXPECT_LT(side * a.x, end - 5e-3);
      EXPECT_FALSE(a.shows(statusword::limit_bit));
      EXPECT_EQ(a.drive.fault(), Fault::none);
      // And to the end again, where it stops by itself.
      a.stream(10'000, side * 0.1);
      EXPECT_NEAR(a.x, side * end, 1e-9);
      EXPECT_EQ(a.set_speed, 0.0);
      EXPECT_TRUE(a.shows(statusword::limit_bit));
      EXPECT_EQ(a.drive.fault(), Fault::none);
    }
}

TEST(Ends, OneMicrometreBeyondThemCyclicTargetsGoBackAndNotOut) {
  for (const double side : {1.0, -1.0}) {
    auto back = enabled_in(OperationMode::cyclic_position, side * beyond);
    EXPECT_EQ(back.drive.state(), operation_enabled) << "with the target where it stands";
    back.stream(3000, side * -0.1);
    EXPECT_LT(side * back.x, end - 5e-3);
    EXPECT_EQ(back.drive.fault(), Fault::none);
    auto out = enabled_in(OperationMode::cyclic_position, side * beyond);
    out.stream(100, side * 0.1);
    EXPECT_EQ(out.drive.fault(), Fault::set_point);
    EXPECT_LT(side * out.x, beyond + 1e-3);
  }
}

TEST(Ends, OneMicrometreBeyondThemTheWayBackIsFreeInEveryMode) {
  using enum OperationMode;
  int back = 0, tried = 0;
  for (const auto mode : {profile_position, profile_velocity, cyclic_position, cyclic_velocity, cyclic_torque})
    for (const double side : {1.0, -1.0}) {
      SCOPED_TRACE(static_cast<int>(mode));
      auto a = enabled_in(mode, side * beyond);
      if (mode == profile_position) offer(a, side * 0.4);
      a.stream(6000, side * -0.1);
      const bool is_back = side * a.x < end - 5e-3 && a.drive.fault() == Fault::none;
      EXPECT_TRUE(is_back) << a.x;
      back += is_back ? 1 : 0;
      ++tried;
    }
  figure("axis 1 um beyond an end: way back, every mode and end",
         std::to_string(back) + " of " + std::to_string(tried) + " (bound all)");
}

TEST(Ends, HomingSearchesBeyondThem) {
  ServedAxis a({}, HomingMethod::limit_positive, beyond);
  ASSERT_TRUE(a.enable());
  a.remote.ask(OperationMode::homing);
  a.remote.ask(on_word | controlword::homing_start_bit);
  for (int i = 0; i < 20'000 && !a.drive.referenced(); ++i) {
    a.inputs.limit_positive = a.x > beyond + 2e-3;
    a.step();
  }
  EXPECT_TRUE(a.drive.referenced());
  EXPECT_EQ(a.drive.fault(), Fault::none);
}

TEST(ProfileMovesOfAnAxis, WaitForTheOneBeforeUnlessTheyAreToBeMadeAtOnce) {
  auto a = enabled_in(OperationMode::profile_position);
  offer(a, 0.05);
  EXPECT_TRUE(a.shows(statusword::acknowledge_bit));
  offer(a, 0.1);
  EXPECT_TRUE(a.shows(statusword::acknowledge_bit)) << "it waits";
  offer(a, 0.2);  // no room
  offer(a, 0.05, controlword::relative_bit);
  for (int i = 0; i < 20'000; ++i) {
    a.step();
    EXPECT_TRUE(a.x > 0.1 - 1e-5 || !a.shows(statusword::target_bit));
  }
  EXPECT_NEAR(a.x, 0.1, 1e-9);
  EXPECT_TRUE(a.shows(statusword::target_bit));
  offer(a, 0.3);
  a.run(200);
  a.remote.ask_deceleration(si<FixedSignals::Velocity>(1.0 * tick));
  offer(a, 0.15, controlword::at_once_bit);
  EXPECT_GE(a.remote.move().deceleration, FixedSignals::Velocity::from_raw(1));
  a.run(20'000);
  EXPECT_NEAR(a.x, 0.15, 1e-9);
  offer(a, 0.16, controlword::at_once_bit);  // at rest
  a.run(20'000);
  EXPECT_NEAR(a.x, 0.16, 1e-9);
  EXPECT_EQ(a.drive.fault(), Fault::none);
}

// As much of a drive as the axis asks for, to stand where no axis with a set-point does.
struct Beside {
  FixedSignals::Position at{}, measured{};
  FixedSignals::Position set_position() const { return at; }
  bool stops_along() const { return false; }
  bool stops_fast() const { return false; }
  FixedSignals::Position position() const { return measured; }
  FixedSignals::Velocity set_velocity() const { return {}; }
  FixedSignals::Velocity velocity() const { return {}; }
  FixedSignals::Current set_current() const { return {}; }
  Fault fault() const { return Fault::none; }
  bool follows() const { return true; }
  bool powered() const { return true; }
  bool referenced() const { return true; }
  bool standing() const { return true; }
};

TEST(ProfileMovesOfAnAxis, AreNotReachedWhereTheAxisIsOutsideOfItsWindow) {
  for (const double off : {5e-6, 15e-6, -15e-6}) {
    auto config = ServedAxis::remote_config({}, {});
    config.streamed = false;
    RemoteAxis axis(config);
    axis.ask(OperationMode::profile_position);
    const Beside drive{{}, si<FixedSignals::Position>(off)};
    for (int i = 0; i < 200; ++i) {
      if (i % 16 == 0) axis.begin_cycle();
      axis.tick(drive);
    }
    EXPECT_EQ(axis.mode(), OperationMode::profile_position);
    EXPECT_EQ((axis.statusword(0) & statusword::target_bit) != 0, off == 5e-6);
  }
}

// Without a controller on CAN csp holds, and no targets are missed.
TEST(Targets, ThatNoBusStreamsAreNotMissed) {
  auto config = ServedAxis::remote_config({}, {});
  config.streamed = false;
  RemoteAxis axis(config);
  axis.ask(controlword::shutdown);
  const Beside drive{};
  for (int i = 0; i < 200; ++i) {
    if (i % 16 == 0) axis.begin_cycle();
    EXPECT_EQ(axis.tick(drive).velocity, FixedSignals::Velocity{});
    EXPECT_EQ(axis.fault(), Fault::none);
    EXPECT_FALSE(axis.brakes());
  }
}

TEST(ProfileMovesOfAnAxis, KeepTheirValuesWithinTheLimitsOfTheMachine) {
  ServedAxis a;
  using V = FixedSignals::Velocity;
  for (const auto& [asked, held] :
       {std::pair{V{}, V::from_raw(1)}, std::pair{si<V>(7.9), si<V>(ServedAxis::most_speed)}}) {
    a.remote.ask_velocity(asked);
    EXPECT_EQ(a.remote.move().velocity, held);
  }
  a.remote.ask_acceleration(si<V>(7.9));
  EXPECT_EQ(a.remote.move().acceleration, si<V>(ServedAxis::acceleration * tick));
  a.remote.ask_target({}, false);
  auto b = enabled_in(OperationMode::profile_position);
  b.remote.ask_target({}, false);
  b.remote.ask(offer_word);
  b.run(2);
  EXPECT_EQ(b.remote.refusal(), Refusal::no_number);
  b.remote.ask(on_word);
  b.run(2);
  EXPECT_FALSE(b.shows(statusword::limit_bit));
}

TEST(ProfileMovesOfAnAxis, HaltAndGoOn) {
  auto a = enabled_in(OperationMode::profile_position);
  offer(a, 0.3);
  a.run(1000);
  a.remote.ask(on_word | controlword::halt_bit);
  a.run(2000);
  EXPECT_EQ(a.set_speed, 0.0);
  EXPECT_TRUE(a.shows(statusword::target_bit)) << "it has halted";
  EXPECT_LT(a.x, 0.2);
  a.remote.ask(on_word);
  a.run(20'000);
  EXPECT_NEAR(a.x, 0.3, 1e-9);
}

TEST(Offsets, AreAddedInCspAndForgottenWithTheirCycles) {
  auto a = enabled_in(OperationMode::cyclic_position);
  using V = FixedSignals::Velocity;
  const auto current = si<FixedSignals::Current>(1.0);
  a.remote.ask_offsets(si<V>(0.01), current);
  a.stream(ServedAxis::cycle_ticks, 0.0);
  EXPECT_EQ(a.remote.velocity_offset(), si<V>(0.01));
  EXPECT_EQ(a.remote.tick(a.drive).injection, current);
  a.stream(4 * ServedAxis::cycle_ticks, 0.0);
  EXPECT_EQ(a.remote.velocity_offset(), V{});
  a.remote.ask(OperationMode::profile_velocity);
  a.remote.ask_offsets(si<V>(0.01), current);
  a.run(3);
  EXPECT_EQ(a.remote.velocity_offset(), V{}) << "of csp alone";
}

// An offset of a standing axis that is stopped: it goes by the ramp before the power does.
TEST(Offsets, OfAStandingAxisEndBeforeItsPower) {
  auto a = enabled_in(OperationMode::cyclic_position);
  for (int i = 0; i < 800; ++i) {
    a.remote.ask_offsets(si<FixedSignals::Velocity>(0.2), {});
    a.stream(1, 0.0);
  }
  EXPECT_NEAR(a.set_speed, 0.2, 1e-7) << name_of(a.drive.fault());
  a.remote.ask(controlword::shutdown);
  double largest = 0.0, last = 1.0;
  for (int i = 0; i < 1000 && a.drive.powered(); ++i) {
    a.stream(1, 0.0);
    largest = std::max(largest, a.drive.powered() ? a.step_of_speed() : 0.0);
    last = a.drive.powered() ? a.set_speed : last;
  }
  EXPECT_EQ(a.drive.state(), ready_to_switch_on);
  EXPECT_EQ(last, 0.0);
  EXPECT_LE(largest, ServedAxis::acceleration * tick + 0x1p-27);
}

TEST(Refusals, HaveASentenceEach) {
  for (std::size_t i = 0; i < refusal_table.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(refusal_table[i].refusal), i);
    EXPECT_NE(std::string(refusal_table[i].text), "");
  }
}

}  // namespace
}  // namespace stiction::test
