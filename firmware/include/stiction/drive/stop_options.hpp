// How an axis stops, as the option codes of CiA 402 say it (IEC 61800-7-201, 605Ah to 605Eh): one table of the codes
// that the drive has. A code that is not in it is refused where it is configured.
#pragma once

#include <array>
#include <cstdint>

namespace stiction {

enum class StopObject : std::uint16_t {
  quick_stop = 0x605a,
  shutdown = 0x605b,           // transition 8
  disable_operation = 0x605c,  // transition 5
  halt = 0x605d,
  fault_reaction = 0x605e,  // of faults that leave the encoder trusted (Reaction::quick_stop)
};

enum class StopRamp : std::uint8_t {
  none,        // the power stage is off at once, the axis coasts
  slow_down,   // slow_down_deceleration
  quick_stop,  // quick_stop_deceleration
};

struct StopOption {
  StopObject object;
  std::int8_t code;
  StopRamp ramp;
  bool held = false;  // under power when it stands
};

// Codes 3, 4, 7 and 8 brake at the limit of current or voltage: the drive has no such ramp.
inline constexpr std::array<StopOption, 14> stop_option_table{{
    {StopObject::quick_stop, 0, StopRamp::none},
    {StopObject::quick_stop, 1, StopRamp::slow_down},
    {StopObject::quick_stop, 2, StopRamp::quick_stop},
    {StopObject::quick_stop, 5, StopRamp::slow_down, true},
    {StopObject::quick_stop, 6, StopRamp::quick_stop, true},
    {StopObject::shutdown, 0, StopRamp::none},
    {StopObject::shutdown, 1, StopRamp::slow_down},
    {StopObject::disable_operation, 0, StopRamp::none},
    {StopObject::disable_operation, 1, StopRamp::slow_down},
    {StopObject::halt, 1, StopRamp::slow_down, true},
    {StopObject::halt, 2, StopRamp::quick_stop, true},
    {StopObject::fault_reaction, 0, StopRamp::none},
    {StopObject::fault_reaction, 1, StopRamp::slow_down},
    {StopObject::fault_reaction, 2, StopRamp::quick_stop},
}};

// What `code` of `object` means; null where the drive does not have it.
constexpr const StopOption* stop_option(StopObject object, std::int8_t code) {
  for (const auto& row : stop_option_table)
    if (row.object == object && row.code == code) return &row;
  return nullptr;
}

// The same; a code that the table does not have is refused where it is configured, and here takes the power off at
// once.
constexpr StopOption stop_way(StopObject object, std::int8_t code) {
  const auto* row = stop_option(object, code);
  return row == nullptr ? StopOption{object, code, StopRamp::none} : *row;
}

// The codes of an axis; each is one of stop_option_table.
struct StopCodes {
  std::int8_t quick_stop = 2, shutdown = 1, disable_operation = 1, halt = 1, fault_reaction = 2;
};

}  // namespace stiction
