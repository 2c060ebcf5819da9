// What each command needs of the machine that it runs on, in one table. What a machine cannot serve is bad input, told
// in one sentence before anything runs.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

inline constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

// Of which axes a command makes use.
enum class Controllers {
  cascade,  // those that the firmware controls
  known,    // those whose controller can be simulated
  any,
};

// Whether a command asks the drive's number formats to hold the machine.
enum class Formats {
  needed,      // what they do not hold is refused
  or_doubles,  // rotary axes that they hold on no radius run in double precision
  any,
};

struct MachineNeeds {
  std::string_view command;    // "impact"; commands without a row of their own need an axis, no more
  std::size_t least_axes = 1;  // of the machine, or of those that --axis chooses
  std::size_t most_axes = any_number;
  std::span<const std::string_view> friction{};  // models of which every axis has one; empty: any
  bool current_controller = false;               // of at least one axis
  bool feed_drive = false;                       // instead of axes
  bool circle_references = false;                // rows [[reference.circle]]
  bool one_axis = false;                         // runs on one axis alone: the one named, or the first
  bool rotary = false;                           // serves rotary axes too
  Controllers controllers = Controllers::cascade;
  Formats formats = Formats::needed;
  std::string_view why{};  // completes "expected exactly two axes: "
};

// The row of a command, or that of commands without one.
const MachineNeeds& needs_of(std::string_view command);

// "found axis X alone; expected exactly two axes: one stands while the other moves", or none.
std::optional<std::string> what_is_missing(const machine::Machine& machine, const MachineNeeds& needs);

}  // namespace stiction::host
