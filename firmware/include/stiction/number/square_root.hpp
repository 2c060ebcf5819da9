// Square root of a whole number, bit by bit: 32 steps of shifts and sums, whatever the number is. Method: C. C. Woo's,
// as in H. S. Warren, "Hacker's Delight", 2013, 11-1.
#pragma once

#include <cstdint>

namespace stiction {

// Of `x`, the largest whole number whose square is not above it.
constexpr std::uint64_t square_root(std::uint64_t x) {
  std::uint64_t result = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 62; bit != 0; bit >>= 2) {
    const std::uint64_t with = result + bit;
    result >>= 1;
    if (x >= with) {
      x -= with;
      result += bit;
    }
  }
  return result;
}

}  // namespace stiction
