// The tables of IEC 61800-7-201 by which a drive goes from state to state, written out as data, and what walks over
// them share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {

using enum DriveState;

// "Table of commands": bits 7, 3, 2, 1, 0 of the controlword. An x of the standard is a bit that is not in the mask.
enum class Word { shutdown, switch_on, enable_operation, disable_voltage, quick_stop };
struct CommandRow {
  Word word;
  std::uint16_t mask, value;
};
inline constexpr std::array<CommandRow, 5> command_rows{{
    {Word::shutdown, 0x07, 0x06},
    {Word::switch_on, 0x0f, 0x07},
    {Word::enable_operation, 0x0f, 0x0f},
    {Word::disable_voltage, 0x02, 0x00},
    {Word::quick_stop, 0x06, 0x02},
}};

// Where a command leads in the end, with what comes on the way: transitions 2 to 12, 15 and 16.
struct WayRow {
  DriveState from;
  Word word;
  DriveState to;
  bool ramp = false;  // a controlled stop before
  bool held = false;  // of a quick stop that is held (605Ah: 5, 6)
};
inline constexpr std::array<WayRow, 30> way_rows{{
    {switch_on_disabled, Word::shutdown, ready_to_switch_on},
    {switch_on_disabled, Word::switch_on, switch_on_disabled},
    {switch_on_disabled, Word::enable_operation, switch_on_disabled},
    {switch_on_disabled, Word::disable_voltage, switch_on_disabled},
    {switch_on_disabled, Word::quick_stop, switch_on_disabled},
    {ready_to_switch_on, Word::shutdown, ready_to_switch_on},
    {ready_to_switch_on, Word::switch_on, switched_on},
    {ready_to_switch_on, Word::enable_operation, operation_enabled},
    {ready_to_switch_on, Word::disable_voltage, switch_on_disabled},
    {ready_to_switch_on, Word::quick_stop, switch_on_disabled},
    {switched_on, Word::shutdown, ready_to_switch_on},
    {switched_on, Word::switch_on, switched_on},
    {switched_on, Word::enable_operation, operation_enabled},
    {switched_on, Word::disable_voltage, switch_on_disabled},
    {switched_on, Word::quick_stop, switch_on_disabled},
    {operation_enabled, Word::shutdown, ready_to_switch_on, true},
    {operation_enabled, Word::switch_on, switched_on, true},
    {operation_enabled, Word::enable_operation, operation_enabled},
    {operation_enabled, Word::disable_voltage, switch_on_disabled},
    {operation_enabled, Word::quick_stop, switch_on_disabled, true},
    {quick_stop_active, Word::shutdown, ready_to_switch_on, true},  // 12, and 2 by the same word
    {quick_stop_active, Word::switch_on, switch_on_disabled, true},
    {quick_stop_active, Word::enable_operation, switch_on_disabled, true},
    {quick_stop_active, Word::disable_voltage, switch_on_disabled},
    {quick_stop_active, Word::quick_stop, switch_on_disabled, true},
    {DriveState::fault, Word::shutdown, DriveState::fault},
    {DriveState::fault, Word::switch_on, DriveState::fault},
    {DriveState::fault, Word::enable_operation, DriveState::fault},
    {DriveState::fault, Word::disable_voltage, DriveState::fault},
    {DriveState::fault, Word::quick_stop, DriveState::fault},
}};

inline constexpr std::array<DriveState, 6> walked_states{switch_on_disabled, ready_to_switch_on, switched_on,
                                                         operation_enabled,  quick_stop_active,  DriveState::fault};
// Those of cam and gear need a master, and are walked in cam_walk.cpp.
inline constexpr auto& walked_modes = standard_modes;
inline constexpr std::array<double, 3> walked_speeds{0.0, 0.2, -0.2};  // m/s

// The most that a limit of the axis lets the set speed change in a tick, and the roundings of two speeds.
inline constexpr double largest_step = ServedAxis::acceleration * tick + 0x1p-27;

inline const CommandRow& row_of(std::uint16_t word) {
  for (const auto& row : command_rows)
    if ((word & row.mask) == row.value) return row;
  ADD_FAILURE() << "a word of no command: " << word;
  return command_rows[0];
}

inline const WayRow& way_of(DriveState from, Word word) {
  for (const auto& row : way_rows)
    if (row.from == from && row.word == word) return row;
  ADD_FAILURE() << "no row";
  return way_rows[0];
}

}  // namespace stiction::test
