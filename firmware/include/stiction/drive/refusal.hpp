// Why an axis did not take a target that came over a bus: one table, for the log and for registers.
#pragma once

#include <array>
#include <cstdint>

namespace stiction {

// Why the last target was not taken; bits 7 and 11 of the statusword say that it was not.
enum class Refusal : std::uint8_t { none, no_number, beyond_end, no_reference };
struct RefusalDescription {
  Refusal refusal;
  const char* text;
};
inline constexpr std::array<RefusalDescription, 4> refusal_table{{
    {Refusal::none, "nothing is refused"},
    {Refusal::no_number, "found a target that is no number; expected one that the units of the bus hold"},
    {Refusal::beyond_end,
     "found a target beyond negative_end or positive_end; expected one within them, or nearer to them than the axis "
     "is"},
    {Refusal::no_reference,
     "found an absolute target of an axis whose zero is not known; expected homing first (mode 6), or a relative move "
     "or a speed"},
}};

}  // namespace stiction
