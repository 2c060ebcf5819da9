// The faults an axis detects. Numbers are stable: they appear in logs and on buses. "Limiting" is not a fault.
#pragma once

#include <array>
#include <cstdint>

namespace stiction {

enum class Fault : std::uint8_t {
  none = 0,
  following_error = 1,
  over_current = 2,
  over_speed = 3,
  position_lost = 4,
  drive_input = 5,
  set_point = 6,
  limit_cycle = 7,
};

struct FaultDescription {
  Fault fault;
  const char* name;
  const char* condition;
  int detection_ticks;  // of the fast loop, from the first violating sample; 0: depends on the signal
};

// Reaction of all: the power stage is disabled in the same tick and the fault latched. Reset of all: a new start of
// the axis with the cause gone.
inline constexpr std::array<FaultDescription, 7> fault_table{{
    {Fault::following_error, "following error", "|x_set - x| above supervision.following_error", 1},
    {Fault::over_current, "over-current", "|i| above supervision.over_current", 1},
    {Fault::over_speed, "over-speed", "|v| above supervision.over_speed", 1},
    {Fault::position_lost, "position lost", "no valid encoder position in three ticks in a row", 3},
    {Fault::drive_input, "drive fault input", "the power stage or the encoder reports a fault", 1},
    {Fault::set_point, "set-point", "a set-point that is not a number or beyond the format's range", 1},
    {Fault::limit_cycle, "limit cycle", "current or voltage from one limit to the other more than 12 times in 125 ms",
     0},
}};

constexpr const char* name_of(Fault fault) {
  for (const auto& row : fault_table)
    if (row.fault == fault) return row.name;
  return "none";
}

// Which limits held an output back in a tick.
struct Limiting {
  bool velocity = false;
  bool current = false;
  bool voltage = false;
};

}  // namespace stiction
