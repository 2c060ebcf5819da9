// What a drive does against friction: a header of its own, as the machine file names it and knows nothing of the laws.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stiction {

enum class CompensationKind : std::uint8_t {
  off,       // set-points are held back all the same, so that the axes of a path stay together
  pulse,     // speed pulse at reversals
  friction,  // current from presliding and sliding curve
  learning,  // the same, and what was learned from the errors of earlier laps
};

// Limits of the laws that the machine file's checks must know too.
inline constexpr std::uint32_t compensation_buffer_ticks = 16;  // of set-points, and of current
inline constexpr std::size_t compensation_element_count = 8;    // of presliding
inline constexpr std::size_t learned_table_nodes = 23;          // of each direction

}  // namespace stiction
