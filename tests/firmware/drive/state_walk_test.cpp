// CiA 402 walked: every state, controlword, mode and motion, against the tables of IEC 61800-7-201 written out here as
// data. Whatever is asked for, the speed of the set-point changes by no more than a limit in a tick, or the power goes.
#include "tests/firmware/drive/state_walk.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

// In a mode and moving in it, as a bus gets it there.
ServedAxis moving(OperationMode mode, double speed, const StopCodes& stops = {}) {
  const auto method = mode != OperationMode::homing ? HomingMethod::none
                      : speed < 0.0                 ? HomingMethod::limit_negative
                                                    : HomingMethod::limit_positive;
  ServedAxis a(stops, method);
  EXPECT_TRUE(a.enable());
  a.remote.ask(mode);
  a.stream(64, 0.0);
  EXPECT_EQ(a.remote.mode(), mode);
  std::uint16_t word = controlword::enable_operation;
  if (speed != 0.0 && mode == OperationMode::homing) word |= controlword::homing_start_bit;
  if (speed != 0.0 && mode == OperationMode::profile_position) {
    a.remote.ask_target(si<FixedSignals::Position>(speed > 0.0 ? 0.45 : -0.45));
    a.remote.ask_velocity(si<FixedSignals::Velocity>(std::abs(speed)));
    word |= controlword::new_set_point_bit;
  }
  a.remote.ask(word);
  a.stream(800, speed);
  EXPECT_NEAR(a.set_speed, speed, 1e-5) << "mode " << static_cast<int>(mode);
  return a;
}

// The same, in a state.
std::optional<ServedAxis> in_state(DriveState state, OperationMode mode, double speed, const StopCodes& stops) {
  auto a = moving(mode, speed, stops);
  if (state == operation_enabled) return a;
  if (state == quick_stop_active) {
    a.remote.ask(controlword::quick_stop);
    a.step();
    if (a.drive.state() != quick_stop_active) return {};
    return a;
  }
  a.remote.ask(controlword::disable_voltage);  // the axis coasts on
  a.run(2);
  if (state == ready_to_switch_on || state == switched_on) a.remote.ask(controlword::shutdown);
  a.run(2);
  if (state == switched_on) a.remote.ask(controlword::switch_on);
  if (state == DriveState::fault) a.trip = Fault::clock_jump;
  a.run(2);
  a.trip = Fault::none;
  if (a.drive.state() != state) return {};
  return a;
}

// Follows a controlword until nothing changes any more.
void check(ServedAxis a, DriveState from, std::uint16_t word, double speed) {
  const auto& row = way_of(from, row_of(word).word);
  const bool reset = from == DriveState::fault && (word & controlword::fault_reset_bit) != 0;
  // 15, and what the word asks for from there.
  const auto to = reset ? way_of(switch_on_disabled, row_of(word).word).to : row.to;
  a.remote.ask(word);
  bool powered_moving = false;
  const bool was_powered = a.drive.powered();
  // 0.2 m/s at 5 m/s^2 are 640 ticks; a standstill of 160; a jerk of 64.
  for (int i = 0; i < 1100; ++i) {
    const bool before = a.drive.powered();
    const double v_before = a.v;
    a.stream(1, speed);
    const bool steady = before && a.drive.powered();
    ASSERT_TRUE(!steady || a.step_of_speed() <= largest_step) << "tick " << i << ": " << a.step_of_speed();
    if (row.ramp && !a.drive.powered() && std::abs(a.v) > 2e-3) powered_moving = true;
    // An axis that coasts is not enabled.
    const bool enabled_in_motion = !before && a.drive.powered() && std::abs(v_before) > 2e-3;
    ASSERT_FALSE(enabled_in_motion);
  }
  ASSERT_FALSE(powered_moving) << "the power went before the stop was over";
  const bool coasts = !was_powered && speed != 0.0;
  if (to == operation_enabled && coasts) {
    ASSERT_EQ(a.drive.state(), switched_on) << "enabled in motion";
    return;
  }
  ASSERT_EQ(a.drive.state(), to);
  ASSERT_EQ(a.drive.powered(), to == operation_enabled);
  const bool halts = to == operation_enabled && (word & controlword::halt_bit) != 0;
  ASSERT_TRUE(!halts || a.set_speed == 0.0) << "halt";
}

TEST(StateWalk, EveryStateControlwordModeAndMotionIsAsTheStandardsTables) {
  int cases = 0;
  for (const auto mode : walked_modes)
    for (const double speed : walked_speeds)
      for (const auto state : walked_states) {
        const auto begin = in_state(state, mode, speed, {});
        ASSERT_TRUE(begin) << "state " << static_cast<int>(state) << " mode " << static_cast<int>(mode);
        for (std::uint16_t word = 0; word < 0x200; ++word) {
          // Bits 4 to 6 offer a target in pp and homing alone; elsewhere they are walked with bit 4 clear and set.
          const bool of_mode = mode == OperationMode::profile_position || mode == OperationMode::homing;
          if (!of_mode && (word & 0x60) != 0) continue;
          SCOPED_TRACE(::testing::Message() << "state " << static_cast<int>(state) << " mode " << static_cast<int>(mode)
                                            << " speed " << speed << " word " << word);
          check(*begin, state, word, speed);
          ++cases;
          if (HasFatalFailure()) return;
        }
      }
  EXPECT_EQ(cases, 6 * 3 * (2 * 512 + 4 * 128));
  figure("states, controlwords, modes and motions that lead where the table of the standard says",
         std::to_string(cases) + " of " + std::to_string(6 * 3 * (2 * 512 + 4 * 128)) + " (bound all)");
}

// Any mode left for any other one, in any motion: it brakes within a limit, and then is the other one.
TEST(StateWalk, AModeIsLeftByARampAndTheNextBeginsAtRest) {
  for (const auto from : walked_modes)
    for (const auto to : walked_modes)
      for (const double speed : walked_speeds) {
        if (from == to) continue;
        SCOPED_TRACE(::testing::Message()
                     << static_cast<int>(from) << " to " << static_cast<int>(to) << " at " << speed);
        auto a = moving(from, speed);
        a.remote.ask(to);
        a.remote.ask(controlword::enable_operation);
        double largest = 0.0;
        for (int i = 0; i < 60'000 && a.remote.mode() != to; ++i) {
          a.stream(1, from == OperationMode::cyclic_velocity || from == OperationMode::cyclic_position ? speed : 0.0);
          largest = std::max(largest, a.step_of_speed());
        }
        EXPECT_EQ(a.remote.mode(), to);
        // In cst the speed that is shown is the axis' own.
        const double still = to == OperationMode::cyclic_torque ? 1e-4 : 1e-9;
        EXPECT_NEAR(a.set_speed, 0.0, still);
        for (int i = 0; i < 200; ++i) {
          a.stream(1, 0.0);
          largest = std::max(largest, a.step_of_speed());
        }
        EXPECT_LE(largest, largest_step);
        EXPECT_EQ(a.drive.fault(), Fault::none) << name_of(a.drive.fault());
        EXPECT_EQ(a.drive.state(), operation_enabled);
        EXPECT_NEAR(a.set_speed, 0.0, still);
      }
}

// What is begun and taken back on the way: a halt, a mode, an enabling word, offsets.
TEST(StateWalk, WhatIsTakenBackInTheMiddleOfARampMakesNoStep) {
  constexpr std::uint16_t on = controlword::enable_operation;
  for (const auto mode : walked_modes)
    for (const double speed : walked_speeds)
      for (const int word : {0x10f, 0x02, 0x06, 0x07})
        for (const auto other : walked_modes)
          for (const int after : {1, 20, 150}) {
            SCOPED_TRACE(::testing::Message() << "mode " << static_cast<int>(mode) << " speed " << speed << " word "
                                              << word << " other " << static_cast<int>(other) << " after " << after);
            auto a = moving(mode, speed);
            double largest = 0.0;
            const auto follow = [&](int count) {
              for (int i = 0; i < count; ++i) {
                a.remote.ask_offsets(si<FixedSignals::Velocity>(i % 64 < 32 ? 0.05 : 0.0), {});
                a.stream(1, speed);
                if (a.drive.powered()) largest = std::max(largest, a.step_of_speed());
              }
            };
            a.remote.ask(static_cast<std::uint16_t>(word));
            a.remote.ask(other);
            follow(after);
            a.remote.ask(on);
            a.remote.ask(mode);
            follow(400);
            ASSERT_LE(largest, largest_step);
          }
}

// Whatever comes in whatever order, drawn: words, modes, targets near and far, offsets, faults of either reaction.
TEST(StateWalk, NoDrawnSequenceStepsTheSetSpeed) {
  std::mt19937_64 draw(27);
  const auto in = [&](double low, double high) { return std::uniform_real_distribution(low, high)(draw); };
  constexpr std::array<std::uint16_t, 9> words{0x0f, 0x0f, 0x1f, 0x10f, 0x02, 0x06, 0x07, 0x80, 0x3f};
  constexpr int walks = 400, ticks_of_walk = 3000;
  double largest = 0.0;
  int powered_ticks = 0, moving_ticks = 0;
  for (int walk = 0; walk < walks; ++walk) {
    ServedAxis a({}, walk % 2 == 0 ? HomingMethod::none : HomingMethod::here);
    ASSERT_TRUE(a.enable());
    double speed = 0.0;
    for (int i = 0; i < ticks_of_walk; ++i) {
      const auto one_in = [&](double n) { return in(0.0, n) < 1.0; };
      if (one_in(100)) speed = in(-1.5, 1.5);
      if (one_in(100)) a.remote.ask(words[draw() % words.size()]);
      if (one_in(150)) a.remote.ask(walked_modes[draw() % walked_modes.size()]);
      if (one_in(200)) a.remote.ask_target(si<FixedSignals::Position>(in(-0.6, 0.6)), !one_in(10));
      if (one_in(200)) a.remote.ask_deceleration(si<FixedSignals::Velocity>(in(0.0, 50.0) * tick));
      if (one_in(200)) a.remote.ask_acceleration(si<FixedSignals::Velocity>(in(0.0, 50.0) * tick));
      if (one_in(200)) a.remote.ask_velocity(si<FixedSignals::Velocity>(in(0.0, 2.0)));
      if (one_in(50)) a.remote.ask_offsets(si<FixedSignals::Velocity>(in(-0.5, 0.5)), {});
      a.trip = one_in(2000) ? Fault::missed_deadline : Fault::none;
      const bool wrong = one_in(3000);
      a.stream(1, speed);
      if (wrong) a.remote.offer(si<FixedSignals::Position>(a.streamed + in(-1e-3, 1e-3)), true);
      if (!a.drive.powered()) {
        a.v = 0.0;
        if (one_in(20)) a.remote.ask(controlword_to_enable(a.drive.state(), true));
        continue;
      }
      ++powered_ticks;
      if (a.set_speed != 0.0) ++moving_ticks;
      largest = std::max(largest, a.step_of_speed());
      ASSERT_LE(largest, largest_step) << "walk " << walk << " tick " << i << " mode "
                                       << static_cast<int>(a.remote.mode()) << " from " << a.set_speed_before << " to "
                                       << a.set_speed;
    }
  }
  EXPECT_GT(powered_ticks, walks * ticks_of_walk / 4);
  EXPECT_GT(moving_ticks, walks * ticks_of_walk / 8);
  figure("400 drawn sequences in every mode: largest change of the set speed in a tick, over max_acceleration",
         std::to_string(largest / (ServedAxis::acceleration * tick)) + " (bound 1.00001)");
}

// 605Ah to 605Eh: the deceleration of each code, and where the axis is afterwards.
struct StopCase {
  StopObject object;
  std::int8_t code;
  std::uint16_t word;   // that begins the stop
  double deceleration;  // m/s^2; 0: none, the power goes at once
  DriveState to;
};
std::vector<StopCase> stop_cases() {
  constexpr double slow = ServedAxis::slow_deceleration, quick = ServedAxis::quick_deceleration;
  constexpr std::uint16_t halt = controlword::enable_operation | controlword::halt_bit;
  return {
      {StopObject::quick_stop, 0, 0x02, 0.0, switch_on_disabled},
      {StopObject::quick_stop, 1, 0x02, slow, switch_on_disabled},
      {StopObject::quick_stop, 2, 0x02, quick, switch_on_disabled},
      {StopObject::quick_stop, 5, 0x02, slow, quick_stop_active},
      {StopObject::quick_stop, 6, 0x02, quick, quick_stop_active},
      {StopObject::shutdown, 0, 0x06, 0.0, ready_to_switch_on},
      {StopObject::shutdown, 1, 0x06, slow, ready_to_switch_on},
      {StopObject::disable_operation, 0, 0x07, 0.0, switched_on},
      {StopObject::disable_operation, 1, 0x07, slow, switched_on},
      {StopObject::halt, 1, halt, slow, operation_enabled},
      {StopObject::halt, 2, halt, quick, operation_enabled},
      {StopObject::fault_reaction, 0, 0x0f, 0.0, DriveState::fault},
      {StopObject::fault_reaction, 1, 0x0f, slow, DriveState::fault},
      {StopObject::fault_reaction, 2, 0x0f, quick, DriveState::fault},
  };
}

StopCodes codes_of(StopObject object, std::int8_t code) {
  StopCodes codes;
  if (object == StopObject::quick_stop) codes.quick_stop = code;
  if (object == StopObject::shutdown) codes.shutdown = code;
  if (object == StopObject::disable_operation) codes.disable_operation = code;
  if (object == StopObject::halt) codes.halt = code;
  if (object == StopObject::fault_reaction) codes.fault_reaction = code;
  return codes;
}

TEST(StopCodesOfAnAxis, BrakeAsTheirTableSaysInEveryModeAndEndWhereItSays) {
  for (const auto& c : stop_cases())
    for (const auto mode : walked_modes) {
      SCOPED_TRACE(::testing::Message() << std::hex << static_cast<int>(c.object) << " code " << int{c.code} << " mode "
                                        << static_cast<int>(mode));
      // A profile halts in its own deceleration, which is that of the axis here, unless a quicker one is asked for.
      const bool profile = mode == OperationMode::profile_position || mode == OperationMode::profile_velocity ||
                           mode == OperationMode::cyclic_velocity;
      const double expected = c.object == StopObject::halt && profile ? ServedAxis::acceleration : c.deceleration;
      auto a = moving(mode, 0.2, codes_of(c.object, c.code));
      a.remote.ask(c.word);
      if (c.object == StopObject::fault_reaction) a.trip = Fault::missed_deadline;
      int ticks = 0;
      bool off_in_motion = false;
      for (; ticks < 4000 && a.set_speed != 0.0 && !off_in_motion; ++ticks) {
        a.stream(1, 0.2);
        a.trip = Fault::none;
        off_in_motion = !a.drive.powered();
      }
      EXPECT_EQ(off_in_motion, c.deceleration == 0.0);
      EXPECT_NEAR(ticks * tick, expected > 0.0 ? 0.2 / expected : 0.0, 66 * tick);
      a.coasts = false;
      a.stream(2000, 0.2);
      EXPECT_EQ(a.drive.state(), c.to);
      EXPECT_EQ(a.drive.powered(), c.to == operation_enabled || c.to == quick_stop_active);
    }
}

TEST(StopCodesOfAnAxis, AreRefusedWhereTheDriveHasNoSuchRamp) {
  std::size_t known = 0;
  for (int object = 0x605a; object <= 0x605e; ++object)
    for (int code = -128; code < 128; ++code)
      known += stop_option(static_cast<StopObject>(object), static_cast<std::int8_t>(code)) != nullptr ? 1 : 0;
  EXPECT_EQ(known, stop_option_table.size());
  EXPECT_EQ(known, stop_cases().size());
  for (const int code : {3, 4, 7, 8})
    EXPECT_EQ(stop_option(StopObject::quick_stop, static_cast<std::int8_t>(code)), nullptr);
  // What is configured all the same coasts and does not hold.
  auto a = moving(OperationMode::cyclic_position, 0.2, codes_of(StopObject::quick_stop, 3));
  a.remote.ask(controlword::quick_stop);
  a.step();
  EXPECT_FALSE(a.drive.powered());
}

TEST(StopCodesOfAnAxis, AStopUnderWayIsMadeFasterAndNeverSlower) {
  auto a = moving(OperationMode::cyclic_position, 0.2);
  a.remote.ask(controlword::shutdown);
  a.run(10);
  a.remote.ask(controlword::quick_stop);
  a.run(2);
  EXPECT_NEAR(a.step_of_speed(), ServedAxis::quick_deceleration * tick, 1e-8);
  a.trip = Fault::missed_deadline;  // its reaction is the same ramp
  a.run(2);
  EXPECT_NEAR(a.step_of_speed(), ServedAxis::quick_deceleration * tick, 1e-8);
}

// 603Fh: a code of the standard or of CiA 301 for each fault, and none without one.
TEST(ErrorCodes, AreThoseOfTheStandard) {
  const std::vector<std::pair<Fault, int>> codes{{Fault::none, 0},
                                                 {Fault::following_error, 0x8611},
                                                 {Fault::over_current, 0x2310},
                                                 {Fault::position_lost, 0x7305},
                                                 {Fault::encoder_jump, 0x7305},
                                                 {Fault::bus_off, 0x8140},
                                                 {Fault::commander_lost, 0x8130},
                                                 {Fault::set_points_lost, 0x8700},
                                                 {Fault::parameters_damaged, 0x6320}};
  for (const auto& [fault, code] : codes) EXPECT_EQ(error_code_of(fault), code) << name_of(fault);
  // FF00h and on are the manufacturer's: they carry the number of the fault.
  for (const auto& row : fault_table) {
    EXPECT_NE(row.error_code, 0) << row.name;
    EXPECT_TRUE(row.error_code < 0xff00 || (row.error_code & 0xff) == static_cast<int>(row.fault)) << row.name;
  }
}

// Bits 4, 9 to 12 and 14, mode by mode.
TEST(Statuswords, SayWhatTheStandardMeansByTheirBits) {
  ServedAxis a;
  EXPECT_TRUE(a.shows(statusword::voltage_bit)) << "supplied, before it is enabled";
  ASSERT_TRUE(a.enable());
  a.stage_fault = true;
  a.step();
  EXPECT_FALSE(a.shows(statusword::voltage_bit));

  auto csv = moving(OperationMode::cyclic_velocity, 0.2);
  EXPECT_TRUE(csv.shows(statusword::follows_bit));
  auto pv = moving(OperationMode::profile_velocity, 0.2);
  EXPECT_TRUE(pv.shows(statusword::target_bit)) << "speed reached";
  EXPECT_FALSE(pv.shows(statusword::speed_zero_bit));
  pv.remote.ask_speed({});
  pv.run(10);
  EXPECT_FALSE(pv.shows(statusword::target_bit));
  pv.run(1000);
  EXPECT_TRUE(pv.shows(statusword::target_bit));
  EXPECT_TRUE(pv.shows(statusword::speed_zero_bit));

  ServedAxis homing({}, HomingMethod::here);
  EXPECT_TRUE(homing.shows(statusword::unreferenced_bit));
  ASSERT_TRUE(homing.enable());
  homing.remote.ask(OperationMode::homing);
  homing.stream(10, 0.0);
  EXPECT_EQ(homing.statusword() & 0x3400, 0x0400) << "not started";
  homing.remote.ask(controlword::enable_operation | controlword::homing_start_bit);
  homing.stream(10, 0.0);
  EXPECT_EQ(homing.statusword() & 0x3400, 0x1400) << "completed";
  EXPECT_FALSE(homing.shows(statusword::unreferenced_bit));
  homing.remote.ask(controlword::enable_operation | controlword::homing_start_bit | controlword::halt_bit);
  homing.stream(10, 0.0);
  EXPECT_EQ(homing.statusword() & 0x3400, 0x1400) << "a halt behind it takes nothing away";

  auto search = moving(OperationMode::homing, 0.2);
  EXPECT_EQ(search.statusword() & 0x3400, 0) << "in progress";
}

}  // namespace
}  // namespace stiction::test
