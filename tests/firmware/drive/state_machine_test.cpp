// Every transition of CiA 402, and no other: each state under each controlword and each set of conditions against the
// standard's own table, written out here by its sentences.
#include "stiction/drive/state_machine.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace stiction {
namespace {

using enum DriveState;
using Conditions = StateMachine::Conditions;

constexpr std::array<DriveState, 8> states{
    not_ready_to_switch_on, switch_on_disabled, ready_to_switch_on,    switched_on,
    operation_enabled,      quick_stop_active,  fault_reaction_active, fault};

// A machine led to a state by controlwords as a controller gives them. Bit 7 was 0 before.
StateMachine machine_in(DriveState state, bool hold) {
  StateMachine m({.hold_after_quick_stop = hold});
  const auto to = [&m](std::uint16_t word, const Conditions& conditions = {}) { m.step(word, conditions); };
  to(0);
  if (state == not_ready_to_switch_on) return m;
  to(0, {.initialised = true});
  if (state == fault_reaction_active || state == DriveState::fault) {
    to(0, {.fault = true});
    if (state == DriveState::fault) to(0, {.stop_ended = true});
    return m;
  }
  const std::map<DriveState, std::vector<std::uint16_t>> ways{
      {switch_on_disabled, {}},
      {ready_to_switch_on, {0x06}},
      {switched_on, {0x06, 0x07}},
      {operation_enabled, {0x06, 0x07, 0x0f}},
      {quick_stop_active, {0x06, 0x07, 0x0f, 0x02}},
  };
  for (const auto word : ways.at(state)) to(word, {.standing = true});
  return m;
}

struct Expected {
  int number;
  DriveState to;
};

// The standard's figure "state machine", transition by transition. `word`: bits 0 to 3 as in its table of commands
// ("x" are left out of the masks).
Expected expected(DriveState from, std::uint16_t word, const Conditions& c, bool hold) {
  const auto is = [word](std::uint16_t mask, std::uint16_t value) { return (word & mask) == value; };
  const bool disable_voltage = is(0x2, 0x0);
  const bool quick_stop = is(0x6, 0x2) || (c.quick_stop && !disable_voltage);
  const bool shutdown = is(0x7, 0x6) && !quick_stop;
  const bool switch_on = is(0xf, 0x7) && !quick_stop;
  const bool enable = is(0xf, 0xf) && !quick_stop;
  const bool reset = is(0x80, 0x80) && !c.cause_present;
  if (c.fault && from != fault_reaction_active && from != DriveState::fault) return {13, fault_reaction_active};
  if (from == not_ready_to_switch_on && c.initialised) return {1, switch_on_disabled};
  if (from == switch_on_disabled && shutdown) return {2, ready_to_switch_on};
  if (from == ready_to_switch_on && (switch_on || enable)) return {3, switched_on};
  if (from == switched_on && enable && c.standing) return {4, operation_enabled};
  if (from == operation_enabled && switch_on && c.stop_ended) return {5, switched_on};
  if (from == switched_on && shutdown) return {6, ready_to_switch_on};
  if (from == ready_to_switch_on && (quick_stop || disable_voltage)) return {7, switch_on_disabled};
  if (from == operation_enabled && shutdown && c.stop_ended) return {8, ready_to_switch_on};
  if (from == operation_enabled && disable_voltage) return {9, switch_on_disabled};
  if (from == switched_on && (quick_stop || disable_voltage)) return {10, switch_on_disabled};
  if (from == operation_enabled && quick_stop) return {11, quick_stop_active};
  if (from == quick_stop_active && (disable_voltage || (c.stop_ended && !hold))) return {12, switch_on_disabled};
  if (from == fault_reaction_active && c.stop_ended) return {14, DriveState::fault};
  if (from == DriveState::fault && reset) return {15, switch_on_disabled};
  if (from == quick_stop_active && enable && c.stop_ended && hold) return {16, operation_enabled};
  return {0, from};
}

TEST(StateMachine, BeginsNotReadyToSwitchOn) {  // transition 0
  EXPECT_EQ(StateMachine({}).state(), not_ready_to_switch_on);
}

TEST(StateMachine, TakesEveryTransitionOfTheStandardAndNoOther) {
  std::set<int> seen{0};
  int cases = 0;
  for (const bool hold : {false, true})
    for (const auto from : states)
      for (std::uint16_t word = 0; word < 0x200; ++word)
        for (int bits = 0; bits < 64; ++bits) {
          const Conditions c{(bits & 1) != 0, (bits & 2) != 0,  (bits & 4) != 0,
                             (bits & 8) != 0, (bits & 16) != 0, (bits & 32) != 0};
          auto machine = machine_in(from, hold);
          ASSERT_EQ(machine.state(), from);
          const int taken = machine.step(word, c);
          const auto right = expected(from, word, c, hold);
          ASSERT_EQ(taken, right.number) << "state " << static_cast<int>(from) << " word " << word << " bits " << bits;
          ASSERT_EQ(machine.state(), right.to) << "state " << static_cast<int>(from) << " word " << word;
          seen.insert(taken);
          ++cases;
        }
  EXPECT_EQ(cases, 2 * 8 * 512 * 64);
  for (int number = 0; number <= 16; ++number) EXPECT_TRUE(seen.contains(number)) << "transition " << number;
}

TEST(StateMachine, TakesAFaultResetOnlyAtItsEdge) {
  auto machine = machine_in(DriveState::fault, false);
  machine.step(controlword::fault_reset, {.cause_present = true});  // refused
  machine.step(controlword::fault_reset, {});                       // still set: no edge
  EXPECT_EQ(machine.state(), DriveState::fault);
  machine.step(0, {});
  EXPECT_EQ(machine.step(controlword::fault_reset, {}), 15);
}

TEST(StateMachine, TakesNoResetThatWasSetBeforeItBegan) {
  StateMachine machine({});
  machine.step(controlword::fault_reset, {.fault = true});
  machine.step(controlword::fault_reset, {.stop_ended = true});
  machine.step(controlword::fault_reset, {});
  EXPECT_EQ(machine.state(), DriveState::fault);
}

// 6041h: xxxx xxxx x0xx 0000, x1xx 0000, x01x 0001, x01x 0011, x01x 0111, x00x 0111, x0xx 1111, x0xx 1000.
TEST(StateMachine, TellsEachStateByItsBitsOfTheStatusword) {
  const std::map<DriveState, std::array<int, 2>> words{
      {not_ready_to_switch_on, {0x4f, 0x00}}, {switch_on_disabled, {0x4f, 0x40}},
      {ready_to_switch_on, {0x6f, 0x21}},     {switched_on, {0x6f, 0x23}},
      {operation_enabled, {0x6f, 0x27}},      {quick_stop_active, {0x6f, 0x07}},
      {fault_reaction_active, {0x4f, 0x0f}},  {DriveState::fault, {0x4f, 0x08}},
  };
  for (const auto& [state, pattern] : words) EXPECT_EQ(statusword::of(state) & pattern[0], pattern[1]);
}

TEST(StateMachine, IsLedToOperationEnabledFromEveryState) {
  for (const auto from : states) {
    auto machine = machine_in(from, false);
    for (int i = 0; i < 8; ++i)
      machine.step(controlword_to_enable(machine.state(), i % 2 == 1),
                   {.initialised = true, .stop_ended = true, .standing = true});
    EXPECT_EQ(machine.state(), operation_enabled) << "from " << static_cast<int>(from);
  }
}

TEST(StateMachine, IsNotLedOutOfAFaultUnasked) {
  auto machine = machine_in(DriveState::fault, false);
  for (int i = 0; i < 8; ++i)
    machine.step(controlword_to_enable(machine.state()), {.initialised = true, .stop_ended = true});
  EXPECT_EQ(machine.state(), DriveState::fault);
}

}  // namespace
}  // namespace stiction
