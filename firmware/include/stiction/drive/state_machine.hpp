// The power drive's state machine of CiA 402 (IEC 61800-7-201, finite state automaton): controlword 6040h in,
// statusword 6041h out, transitions 1 to 16 by their numbers there; 0 is the construction. One table of transitions,
// at most one of them a step.
#pragma once

#include <array>
#include <cstdint>

namespace stiction {

enum class DriveState : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

// Modes of operation 6060h that the drive has.
enum class OperationMode : std::int8_t {
  gear = -2,             // of the manufacturer's range: behind a master by a ratio (cam_mode.hpp)
  cam = -1,              // and along a table
  profile_position = 1,  // pp: the drive moves to a target by itself (remote_axis.hpp)
  profile_velocity = 3,  // pv: the drive goes to a speed by itself
  homing = 6,
  cyclic_position = 8,  // csp: a set-point each tick
  cyclic_velocity = 9,  // csv: a speed each cycle
  cyclic_torque = 10,   // cst: a current each cycle (torque_mode.hpp)
};

// Those of the standard, which every axis has.
inline constexpr std::array<OperationMode, 6> standard_modes{
    OperationMode::profile_position, OperationMode::profile_velocity, OperationMode::homing,
    OperationMode::cyclic_position,  OperationMode::cyclic_velocity,  OperationMode::cyclic_torque};
// 6502h, a bit a mode: bit 0 is mode 1, bit 16 mode -1.
inline constexpr std::array<OperationMode, 8> supported_modes{OperationMode::profile_position,
                                                              OperationMode::profile_velocity,
                                                              OperationMode::homing,
                                                              OperationMode::cyclic_position,
                                                              OperationMode::cyclic_velocity,
                                                              OperationMode::cyclic_torque,
                                                              OperationMode::cam,
                                                              OperationMode::gear};
// Targets each cycle: the drive follows them, and misses them.
constexpr bool is_cyclic(OperationMode mode) {
  return mode == OperationMode::cyclic_position || mode == OperationMode::cyclic_velocity ||
         mode == OperationMode::cyclic_torque;
}
// Behind a master.
constexpr bool is_coupled(OperationMode mode) { return mode == OperationMode::cam || mode == OperationMode::gear; }
constexpr bool is_supported(int mode) {
  for (const auto known : supported_modes)
    if (static_cast<int>(known) == mode) return true;
  return false;
}
constexpr std::uint32_t supported_mode_bits() {
  std::uint32_t bits = 0;
  for (const auto known : supported_modes) {
    const int mode = static_cast<int>(known);
    bits |= 1u << (mode > 0 ? mode - 1 : 15 - mode);
  }
  return bits;
}

// Bits of 6040h, and the words that give the commands.
namespace controlword {
inline constexpr std::uint16_t switch_on_bit = 1u << 0, enable_voltage_bit = 1u << 1, quick_stop_bit = 1u << 2,
                               enable_operation_bit = 1u << 3, homing_start_bit = 1u << 4, fault_reset_bit = 1u << 7;
// pp: a new target; it takes the place of the move under way; it counts from the target before; the move halts.
inline constexpr std::uint16_t new_set_point_bit = 1u << 4, at_once_bit = 1u << 5, relative_bit = 1u << 6,
                               halt_bit = 1u << 8;
inline constexpr std::uint16_t disable_voltage = 0x00, quick_stop = 0x02, shutdown = 0x06, switch_on = 0x07,
                               enable_operation = 0x0f, fault_reset = fault_reset_bit;
}  // namespace controlword

// The commands are coded in bits 0 to 3; every word is one of them. As bits, for sets of them.
enum class DriveCommand : std::uint8_t {
  disable_voltage = 1,
  quick_stop = 2,
  shutdown = 4,
  switch_on = 8,  // in operation enabled: disable operation
  enable_operation = 16,
};

constexpr DriveCommand command_of(std::uint16_t word) {
  if ((word & controlword::enable_voltage_bit) == 0) return DriveCommand::disable_voltage;
  if ((word & controlword::quick_stop_bit) == 0) return DriveCommand::quick_stop;
  if ((word & controlword::switch_on_bit) == 0) return DriveCommand::shutdown;
  return (word & controlword::enable_operation_bit) == 0 ? DriveCommand::switch_on : DriveCommand::enable_operation;
}

class StateMachine {
 public:
  struct Config {
    // Quick stop option code 605Ah. False: 0 to 2, the power goes off behind the stop; true: 5 and 6, the axis is held
    // and may be enabled again from there (transition 16).
    bool hold_after_quick_stop = false;
  };

  // What the drive knows beside the controlword.
  struct Conditions {
    bool initialised = false;    // the self-test has passed
    bool fault = false;          // one was seen in this tick
    bool quick_stop = false;     // demanded by the drive itself, as by bit 2 of the controlword
    bool stop_ended = false;     // a controlled stop is over, or none is under way
    bool standing = false;       // the axis is at rest: none that coasts is enabled
    bool cause_present = false;  // what led to the fault still holds: no reset
  };

  struct State {
    DriveState state = DriveState::not_ready_to_switch_on;
    bool reset_bit = true;  // of the controlword before; a first word that has it set is no edge
  };

  explicit constexpr StateMachine(const Config& config) : config_(config) {}

  constexpr DriveState state() const { return state_.state; }

  // One step. Returns the number of the transition that was taken, 0 for none.
  constexpr std::uint8_t step(std::uint16_t word, const Conditions& conditions) {
    const bool bit = (word & controlword::fault_reset_bit) != 0;
    const bool reset = bit && !state_.reset_bit && !conditions.cause_present;
    state_.reset_bit = bit;
    auto command = command_of(word);
    if (conditions.quick_stop && command != DriveCommand::disable_voltage) command = DriveCommand::quick_stop;
    const unsigned open = (conditions.initialised ? initialised : 0u) | (conditions.fault ? faulted : 0u) |
                          (conditions.stop_ended ? stop_ended : 0u) | (reset ? reset_taken : 0u) |
                          (conditions.standing ? standing : 0u) | (config_.hold_after_quick_stop ? held : let_go);
    Transition taken{};
    for (const auto& row : table) {
      const bool holds = row.from == state_.state && (row.commands & static_cast<unsigned>(command)) != 0 &&
                         (row.gates & open) == row.gates;
      if (holds && taken.number == 0) taken = row;
    }
    if (taken.number != 0) state_.state = taken.to;
    return taken.number;
  }

 private:
  struct Transition {
    std::uint8_t number = 0;
    DriveState from{}, to{};
    unsigned commands = 0;  // that lead to it
    unsigned gates = 0;     // what must hold beside
  };

  static constexpr unsigned initialised = 1, faulted = 2, stop_ended = 4, reset_taken = 8, held = 16, let_go = 32,
                            standing = 64;
  static constexpr unsigned disable_voltage = 1, quick_stop = 2, shutdown = 4, switch_on = 8, enable = 16, any = 31;

  // Those of a fault come first: nothing else happens in its tick.
  static constexpr std::array<Transition, 22> table{{
      {13, DriveState::not_ready_to_switch_on, DriveState::fault_reaction_active, any, faulted},
      {13, DriveState::switch_on_disabled, DriveState::fault_reaction_active, any, faulted},
      {13, DriveState::ready_to_switch_on, DriveState::fault_reaction_active, any, faulted},
      {13, DriveState::switched_on, DriveState::fault_reaction_active, any, faulted},
      {13, DriveState::operation_enabled, DriveState::fault_reaction_active, any, faulted},
      {13, DriveState::quick_stop_active, DriveState::fault_reaction_active, any, faulted},
      {14, DriveState::fault_reaction_active, DriveState::fault, any, stop_ended},
      {15, DriveState::fault, DriveState::switch_on_disabled, any, reset_taken},
      {1, DriveState::not_ready_to_switch_on, DriveState::switch_on_disabled, any, initialised},
      {2, DriveState::switch_on_disabled, DriveState::ready_to_switch_on, shutdown, 0},
      {3, DriveState::ready_to_switch_on, DriveState::switched_on, switch_on | enable, 0},
      {4, DriveState::switched_on, DriveState::operation_enabled, enable, standing},
      {5, DriveState::operation_enabled, DriveState::switched_on, switch_on, stop_ended},
      {6, DriveState::switched_on, DriveState::ready_to_switch_on, shutdown, 0},
      {7, DriveState::ready_to_switch_on, DriveState::switch_on_disabled, quick_stop | disable_voltage, 0},
      {8, DriveState::operation_enabled, DriveState::ready_to_switch_on, shutdown, stop_ended},
      {9, DriveState::operation_enabled, DriveState::switch_on_disabled, disable_voltage, 0},
      {10, DriveState::switched_on, DriveState::switch_on_disabled, quick_stop | disable_voltage, 0},
      {11, DriveState::operation_enabled, DriveState::quick_stop_active, quick_stop, 0},
      {12, DriveState::quick_stop_active, DriveState::switch_on_disabled, disable_voltage, 0},
      {12, DriveState::quick_stop_active, DriveState::switch_on_disabled, any, stop_ended | let_go},
      {16, DriveState::quick_stop_active, DriveState::operation_enabled, enable, stop_ended | held},
  }};

  Config config_;
  State state_;
};

// Bits of 6041h.
namespace statusword {
// voltage: the power stage reports no fault of its supply; warning: a command was refused, the state is as it was;
// remote: the controlword of a bus is obeyed.
inline constexpr std::uint16_t fault_bit = 1u << 3, voltage_bit = 1u << 4, warning_bit = 1u << 7, remote_bit = 1u << 9,
                               target_bit = 1u << 10, limit_bit = 1u << 11;
inline constexpr std::uint16_t follows_bit = 1u << 12;       // csp, csv, cst: the drive follows them
inline constexpr std::uint16_t acknowledge_bit = 1u << 12;   // pp: the new target was taken
inline constexpr std::uint16_t homed_bit = 1u << 12;         // homing: attained
inline constexpr std::uint16_t speed_zero_bit = 1u << 12;    // pv: the axis is at rest
inline constexpr std::uint16_t homing_error_bit = 1u << 13;  // homing
// pp, csp: the following error was out of its window (6065h) for longer than 6066h; pv: the slippage of the standard,
// which is the same error here, as a speed is led by a position. Reserved in csv and cst.
inline constexpr std::uint16_t following_error_bit = 1u << 13;
inline constexpr std::uint16_t torque_off_bit = 1u << 8;     // of the manufacturer: safe torque off
inline constexpr std::uint16_t unreferenced_bit = 1u << 14;  // of the manufacturer: the zero of the axis is not known
inline constexpr std::uint16_t state_bits = 0x6f;            // bits 0 to 3, 5, 6 tell the state

// Bits 0 to 3, 5 and 6.
constexpr std::uint16_t of(DriveState state) {
  constexpr std::array<std::uint16_t, 8> words{0x00, 0x40, 0x21, 0x23, 0x27, 0x07, 0x0f, 0x08};
  return words[static_cast<std::size_t>(state)];
}
}  // namespace statusword

// The controlword that leads a drive on from a state, as a controller gives it step by step: to operation enabled, and
// out of a fault only where `reset`.
constexpr std::uint16_t controlword_to_enable(DriveState state, bool reset = false) {
  switch (state) {
    case DriveState::switch_on_disabled:
      return controlword::shutdown;
    case DriveState::ready_to_switch_on:
      return controlword::switch_on;
    case DriveState::switched_on:
    case DriveState::operation_enabled:
      return controlword::enable_operation;
    case DriveState::quick_stop_active:  // let the stop end
      return controlword::quick_stop;
    case DriveState::fault:
      return reset ? controlword::fault_reset : controlword::disable_voltage;
    default:
      return controlword::disable_voltage;
  }
}

}  // namespace stiction
