// Who may command: stops of everybody, one owner, and what becomes of an axis whose commander is gone.
#include "stiction/drive/command_owner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "tests/firmware/drive/served_axis.hpp"
#include "tests/support/figure.hpp"

namespace stiction::test {
namespace {

using enum DriveState;
using enum CommandSource;

constexpr std::uint32_t watch_ticks = 800;  // 50 ms

CommandOwner::Config watched(AbortReaction reaction = AbortReaction::fault) {
  return {{0, watch_ticks, watch_ticks}, reaction};
}

bool lead(ServedAxis& a, CommandSource source) {
  for (int i = 0; i < 600 && a.drive.state() != operation_enabled; ++i) {
    a.remote.ask(controlword_to_enable(a.drive.state()), source);
    a.stream(1, 0.0);
  }
  return a.drive.state() == operation_enabled;
}

// Moving at 0.2 m/s in a mode, commanded by a source that is heard each tick.
ServedAxis commanded(OperationMode mode, CommandSource source, const CommandOwner::Config& config) {
  ServedAxis a({}, mode == OperationMode::homing ? HomingMethod::limit_positive : HomingMethod::none, 0.0, config);
  EXPECT_TRUE(lead(a, source));
  a.remote.ask(mode);
  const auto run = [&](std::uint16_t word, int ticks, double speed) {
    for (int i = 0; i < ticks; ++i) {
      a.remote.ask(word, source);
      a.stream(1, speed);
    }
  };
  std::uint16_t word = controlword::enable_operation;
  run(word, 64, 0.0);
  EXPECT_EQ(a.remote.mode(), mode);
  if (mode == OperationMode::homing) word |= controlword::homing_start_bit;
  if (mode == OperationMode::profile_position) {
    a.remote.ask_target(si<FixedSignals::Position>(0.45));
    a.remote.ask_velocity(si<FixedSignals::Velocity>(0.2));
    word |= controlword::new_set_point_bit;
  }
  run(word, 800, 0.2);
  EXPECT_NEAR(a.set_speed, 0.2, 1e-5);
  EXPECT_EQ(a.remote.owner().owner(), source);
  return a;
}

// 6007h again, whatever the watch's time is: also without one.
TEST(Commander, WhoseConnectionEndsIsGoneAtOnce) {
  struct Row {
    AbortReaction reaction;
    Fault fault;
    bool stops;
  };
  constexpr Row rows[]{{AbortReaction::none, Fault::none, false},
                       {AbortReaction::fault, Fault::commander_lost, true},
                       {AbortReaction::disable_voltage, Fault::none, true},
                       {AbortReaction::quick_stop, Fault::none, true}};
  for (const auto& row : rows)
    for (const bool is_watched : {true, false}) {
      CommandOwner::Config config = watched(row.reaction);
      if (!is_watched) config.timeout_ticks = {};
      auto a = commanded(OperationMode::profile_velocity, can, config);
      a.remote.disconnect(modbus);
      a.stream(32, 0.2);
      EXPECT_EQ(a.remote.owner().owner(), can) << "of a source that does not command it";
      a.remote.disconnect(can);
      a.remote.disconnect(can);
      a.stream(400, 0.2);
      EXPECT_EQ(a.drive.fault(), row.fault);
      EXPECT_EQ(a.remote.owner().owner() == none, row.stops);
      EXPECT_EQ(a.set_speed == 0.0, row.stops);
    }
  // Of an axis that nobody commands it is nothing, and the next commander is none that is gone.
  ServedAxis a({}, HomingMethod::none, 0.0, watched());
  a.remote.disconnect(none);
  a.remote.disconnect(can);
  EXPECT_TRUE(lead(a, can));
  EXPECT_EQ(a.remote.owner().owner(), can);
}

TEST(Commander, GoneInAnyModeIsAStopWithinItsTimeAndTheRamp) {
  int cases = 0, at_rest = 0;
  for (const auto mode : standard_modes)
    for (const auto source : {can, modbus}) {
      SCOPED_TRACE(::testing::Message() << "mode " << static_cast<int>(mode) << ", " << name_of(source));
      const bool streamed = is_cyclic(mode);
      if (mode == OperationMode::cyclic_position && source == modbus) continue;  // holds
      auto a = commanded(mode, source, watched());
      int ticks = 0;
      for (; ticks < 4000 && a.set_speed != 0.0; ++ticks) a.step();
      const double most = watch_ticks * tick + 0.2 / ServedAxis::quick_deceleration + 3 * tick;
      EXPECT_LE(ticks * tick, most);
      ++cases;
      at_rest += a.set_speed == 0.0 && ticks * tick <= most ? 1 : 0;
      a.run(400);
      EXPECT_EQ(a.drive.state(), DriveState::fault);
      EXPECT_FALSE(a.drive.powered());
      EXPECT_EQ(a.drive.fault(), streamed && source == can ? Fault::set_points_lost : Fault::commander_lost);
    }
  EXPECT_EQ(cases, 11);
  figure("commander gone in every mode, over CAN and over Modbus: at rest within its time and the ramp",
         std::to_string(at_rest) + " of " + std::to_string(cases) + " (bound all)");
}

TEST(Commander, ThatIsHeardIsNotLost) {
  auto a = commanded(OperationMode::profile_velocity, can, watched());
  for (int i = 0; i < 10; ++i) {
    a.run(watch_ticks - 10);
    a.remote.hear(can);
  }
  EXPECT_EQ(a.drive.fault(), Fault::none);
  for (int i = 0; i < 10; ++i) {
    a.run(watch_ticks / 5);
    a.remote.hear(modbus);  // a different one
  }
  EXPECT_EQ(a.drive.fault(), Fault::commander_lost);
}

TEST(Commander, GoneIsAnsweredAs6007hSays) {
  struct Row {
    AbortReaction reaction;
    Fault fault;
    bool power_at_once, moves;
  };
  for (const auto& row : {Row{AbortReaction::none, Fault::none, true, true},
                          Row{AbortReaction::fault, Fault::commander_lost, true, false},
                          Row{AbortReaction::disable_voltage, Fault::none, false, false},
                          Row{AbortReaction::quick_stop, Fault::none, true, false}}) {
    SCOPED_TRACE(static_cast<int>(row.reaction));
    auto a = commanded(OperationMode::profile_velocity, modbus, watched(row.reaction));
    a.coasts = false;
    a.run(watch_ticks + 2);
    EXPECT_EQ(a.drive.powered(), row.power_at_once);
    a.run(2000);
    EXPECT_EQ(a.drive.fault(), row.fault);
    EXPECT_EQ(a.set_speed != 0.0, row.moves);
    EXPECT_EQ(a.drive.powered(), row.moves);
    EXPECT_EQ(a.remote.owner().owner() != none, row.moves);
  }
}

TEST(Commander, LostIsResetOnlyWhenOneIsHeardAgain) {
  auto a = commanded(OperationMode::profile_velocity, can, watched());
  a.run(3000);
  ASSERT_EQ(a.drive.fault(), Fault::commander_lost);
  a.remote.hear(can);  // is no word
  a.run(10);
  EXPECT_EQ(a.remote.fault(), Fault::commander_lost);
  a.remote.ask(controlword::disable_voltage, can);
  a.run(10);
  a.remote.ask(controlword::fault_reset, can);
  a.run(10);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  EXPECT_TRUE(lead(a, can));
}

TEST(Commander, LostWithoutPowerIsNoFaultAndLeavesTheAxisToOthers) {
  ServedAxis a({}, HomingMethod::none, 0.0, watched());
  a.stream(100, 0.0);
  a.remote.ask(controlword::shutdown, can);
  a.run(10);
  EXPECT_EQ(a.remote.owner().owner(), can);
  EXPECT_EQ(a.drive.state(), ready_to_switch_on);
  a.run(watch_ticks);
  EXPECT_EQ(a.remote.owner().owner(), none);
  EXPECT_EQ(a.drive.state(), switch_on_disabled);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  EXPECT_TRUE(lead(a, modbus));
}

// Words of one source against the stop of another one, in any order and rate: the stop wins, and the axis stays off
// until its sender lifts it.
TEST(Stops, WinAgainstEnablingWordsOfOthersInAnyOrderAndAtAnyRate) {
  std::mt19937 draw(27);
  const auto any = [&](int most) { return static_cast<int>(draw() % static_cast<unsigned>(most)); };
  constexpr std::array<std::uint16_t, 4> stops{0x00, 0x02, 0x06, 0x07}, enabling{0x06, 0x07, 0x0f, 0x1f};
  int won = 0;
  for (int k = 0; k < 1000; ++k) {
    ServedAxis a;
    const auto stopping = any(2) == 0 ? can : modbus, other = stopping == can ? modbus : can;
    const bool moving = any(3) != 0;
    if (moving) {
      ASSERT_TRUE(lead(a, other));
      a.remote.ask(OperationMode::profile_velocity);
      a.stream(40, 0.2);
      a.stream(any(400), 0.2);
    } else {
      a.stream(70 + any(30), 0.0);
    }
    const int pause = 1 + any(20);
    const auto sends = [&] {
      for (int i = any(3); i >= 0; --i) a.remote.ask(enabling[static_cast<std::size_t>(any(4))], other);
    };
    if (any(2) == 0) sends();  // before, in its tick, behind it
    if (!moving && a.remote.owner().owner() == none && any(2) == 0) a.remote.ask(0x06, other);
    // Shutdown and switch on of who finds an axis without an owner ask for it.
    const bool owned = a.remote.owner().owner() == other;
    a.remote.ask(stops[static_cast<std::size_t>(owned ? any(4) : any(2))], stopping);
    sends();
    bool enabled_again = false, was_off = !a.drive.powered();
    for (int i = 0; i < 1500; ++i) {
      if (i % pause == 0) sends();
      a.step();
      was_off |= !a.drive.powered();
      enabled_again |= was_off && a.drive.powered();
    }
    const bool stopped = !a.drive.powered() && a.set_speed == 0.0 && !enabled_again;
    EXPECT_TRUE(stopped) << "case " << k;
    EXPECT_EQ(a.remote.owner().held_by(), stopping);
    won += stopped ? 1 : 0;
    // Its sender lifts it, which moves nothing; then the other one leads the axis again.
    a.coasts = false;
    EXPECT_FALSE(a.remote.ask(controlword::enable_operation, stopping));
    a.stream(100, 0.0);
    EXPECT_FALSE(a.drive.powered());
    EXPECT_TRUE(lead(a, other)) << "case " << k;
  }
  figure("stop over one bus against enabling words over the other", std::to_string(won) + " of 1000 won (bound all)");
  EXPECT_EQ(won, 1000);
}

TEST(Owners, AreOneAtATimeWithATokenThatTellsEachChange) {
  ServedAxis a;
  EXPECT_EQ(a.remote.owner().owner(), none);
  EXPECT_EQ(a.remote.owner().held_by(), none);
  EXPECT_TRUE(a.remote.owner().accepts(modbus));
  a.stream(100, 0.0);
  EXPECT_FALSE(a.remote.ask(controlword::enable_operation, can)) << "only shutdown or switch on lead an idle axis";
  EXPECT_TRUE(a.remote.ask(controlword::shutdown, can));
  EXPECT_EQ(a.remote.owner().token(), 1);
  EXPECT_TRUE(a.remote.owner().accepts(can));
  EXPECT_FALSE(a.remote.owner().accepts(modbus));
  EXPECT_FALSE(a.remote.ask(controlword::enable_operation, modbus));
  EXPECT_TRUE(lead(a, can));
  EXPECT_EQ(a.remote.owner().token(), 1);
  // Given up where the voltage is disabled.
  a.remote.ask(controlword::disable_voltage, can);
  a.run(3);
  EXPECT_EQ(a.remote.owner().owner(), none);
  EXPECT_EQ(a.remote.owner().token(), 2);
  EXPECT_TRUE(lead(a, modbus));
  EXPECT_EQ(a.remote.owner().owner(), modbus);
}

// A source with several commanders: of the ones that the axis does not belong to a word stops it, and nothing else.
TEST(Owners, OfASourceWithSeveralAreStoppedByTheOthersOfIt) {
  for (const std::uint16_t word : {controlword::shutdown, controlword::quick_stop}) {
    ServedAxis a;
    ASSERT_TRUE(lead(a, modbus));
    EXPECT_TRUE(a.remote.ask(word, modbus, true));
    EXPECT_EQ(a.remote.owner().owner(), none);
    EXPECT_EQ(a.remote.owner().held_by(), modbus);
    a.run(400);
    EXPECT_FALSE(a.drive.powered());
    EXPECT_TRUE(a.remote.ask(controlword::shutdown, modbus, true)) << "once more; it leads nothing";
    EXPECT_EQ(a.remote.owner().owner(), none);
    EXPECT_FALSE(a.remote.ask(controlword::enable_operation, modbus));
    EXPECT_TRUE(lead(a, modbus));
  }
}

TEST(Owners, OfAnIdleAxisAreRefusedWhileADifferentSourceHoldsIt) {
  ServedAxis a;
  a.stream(100, 0.0);
  a.remote.ask(controlword::quick_stop, modbus);
  a.remote.ask(controlword::disable_voltage, can);
  EXPECT_EQ(a.remote.controlword(), controlword::disable_voltage) << "the one that stops most";
  ServedAxis b;
  b.remote.ask(controlword::disable_voltage, modbus);
  b.remote.ask(controlword::quick_stop, can);
  EXPECT_EQ(b.remote.controlword(), controlword::disable_voltage) << "whoever gave it";
  a.remote.ask(controlword::shutdown, can);
  EXPECT_EQ(a.remote.owner().owner(), none);
  a.run(10);
  EXPECT_EQ(a.drive.state(), switch_on_disabled);
  a.remote.ask(controlword::enable_operation, modbus);
  EXPECT_TRUE(lead(a, can));
}

TEST(Owners, HaveANameEach) {
  EXPECT_STREQ(name_of(none), "none");
  EXPECT_STREQ(name_of(can), "CAN");
  EXPECT_STREQ(name_of(modbus), "Modbus");
}

}  // namespace
}  // namespace stiction::test
