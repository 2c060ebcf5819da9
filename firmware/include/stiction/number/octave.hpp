// Where a magnitude lies in a table whose nodes are spaced like its leading bits: 0, then two nodes an octave, 2^k and
// 1.5 * 2^k. A leading-zero count finds the place without a search or a division, and a table of 32 words covers five
// decades: friction needs its detail near standstill.
#pragma once

#include <bit>
#include <cstdint>

namespace stiction {

// Fraction bits of the place between two nodes.
inline constexpr int octave_fraction_bits = 28;

struct OctavePlace {
  int node;               // the lower one of the two nodes around
  std::int32_t fraction;  // 0 .. 2^28 - 1 of the way to the next
};

// `raw`: a magnitude below 2^31; node 1 is at 2^LowestBit. The highest place is below node 2 (31 - LowestBit) + 1.
template <int LowestBit>
constexpr OctavePlace octave_place(std::uint32_t raw) {
  static_assert(LowestBit > 1 && LowestBit <= octave_fraction_bits);
  // Below the first node the way from 0 is linear; the bit that is set there keeps the count of zeros defined.
  const bool below = raw < (1u << LowestBit);
  const int zeros = std::countl_zero(raw | 1u);
  const std::uint32_t mantissa = (raw << zeros) << 1;  // what follows the leading bit
  const int octave = 31 - zeros - LowestBit;
  const int node = below ? 0 : 1 + 2 * octave + static_cast<int>(mantissa >> 31);
  const std::uint32_t fraction =
      below ? raw << (octave_fraction_bits - LowestBit) : (mantissa << 1) >> (32 - octave_fraction_bits);
  return {node, static_cast<std::int32_t>(fraction)};
}

// Nodes of a table that begins at 2^LowestBit and covers every magnitude below 2^31.
template <int LowestBit>
inline constexpr int octave_nodes = 2 * (31 - LowestBit) + 2;

}  // namespace stiction
