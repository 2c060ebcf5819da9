// Integer sine and cosine of an angle counted in turns: one polynomial, the same bits on every target.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/number/fixed.hpp"

namespace stiction {

// An angle as a fraction of a turn, raw * 2^-32; it wraps by nature.
struct Turn {
  std::uint32_t raw = 0;
};

using Sine = Coefficient<30>;

// sin(2 pi turn), within 6e-9: an odd polynomial of degree 9 in the quarter turn, minimax over it (3.4e-9), and the
// rounding of its five steps.
constexpr Sine sine(Turn turn) {
  constexpr std::int64_t quarter = std::int64_t{1} << 30;
  std::int64_t folded = static_cast<std::int32_t>(turn.raw);  // -half .. half a turn
  if (folded > quarter) folded = 2 * quarter - folded;
  if (folded < -quarter) folded = -2 * quarter - folded;
  const auto u = Coefficient<30>::from_bounded_raw(folded);  // quarter turns, -1 .. 1

  SaturationCounter none;  // the polynomial stays within +-1.58, the format within +-2
  const auto square = narrow<Coefficient<30>>(u * u, none);
  constexpr std::array<std::int32_t, 4> lower{-5016767, 85564854, -693597876, 1686629674};
  auto sum = Fixed<30>::from_raw(161942);
  for (const std::int32_t coefficient : lower)
    sum = narrow<Fixed<30>>(sum * square + Fixed<30>::from_raw(coefficient), none);
  return narrow<Sine>(sum * u, none);
}

constexpr Sine cosine(Turn turn) { return sine(Turn{turn.raw + 0x40000000u}); }

}  // namespace stiction
