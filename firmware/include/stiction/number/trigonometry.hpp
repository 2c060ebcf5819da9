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

namespace detail {

constexpr std::uint32_t upper_word_of_product(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>((std::uint64_t{a} * b) >> 32);
}

}  // namespace detail

// sin(2 pi turn), within 6e-9: an odd polynomial of degree 9 in the quarter turn, minimax over it with 1 at its end
// (4.8e-9). Its terms alternate in sign, so that unsigned words hold every partial sum and each step is one upper word
// of a product; those are cut, not rounded (within the 6e-9), the result is rounded.
constexpr Sine sine(Turn turn) {
  constexpr std::uint32_t quarter = std::uint32_t{1} << 30;
  const bool negative = (turn.raw >> 31) != 0;
  const std::uint32_t magnitude = negative ? 0u - turn.raw : turn.raw;  // 0 .. half a turn
  const std::uint32_t folded = magnitude > quarter ? 2 * quarter - magnitude : magnitude;
  const std::uint32_t u = 2 * folded - (folded >> 30);  // quarter turns * 2^31; 1 is out of the word by one bit
  const std::uint32_t square = detail::upper_word_of_product(2 * u, 2 * u);  // * 2^32

  constexpr std::array<std::uint32_t, 4> lower{10033633, 171129973, 1387195903, 3373259369};  // * 2^31
  std::uint32_t sum = 323842;
  for (const std::uint32_t coefficient : lower) sum = coefficient - detail::upper_word_of_product(sum, square);
  const auto rounded = static_cast<std::int32_t>((std::uint64_t{sum} * u + (std::uint64_t{1} << 31)) >> 32);
  return Sine::from_bounded_raw(negative ? -rounded : rounded);
}

constexpr Sine cosine(Turn turn) { return sine(Turn{turn.raw + 0x40000000u}); }

}  // namespace stiction
