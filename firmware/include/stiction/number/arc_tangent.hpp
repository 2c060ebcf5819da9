// The angle of a vector of whole numbers, by turning it onto the first axis in halved steps (Volder 1959, "The CORDIC
// trigonometric computing technique"): shifts and sums, the same work for every vector.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/number/trigonometry.hpp"

namespace stiction {

// Angle of (x, y) from the first axis, within 2^-18 turns for vectors longer than 2^21; the zero vector has angle zero.
// `x`, `y`: |.| below 2^61.
constexpr Turn angle_of(std::int64_t x, std::int64_t y) {
  constexpr std::array<std::uint32_t, 24> steps{// arctan(2^-k) / (2 pi) * 2^32
                                                536870912, 316933406, 167458907, 85004756, 42667331, 21354465,
                                                10679838,  5340245,   2670163,   1335087,  667544,   333772,
                                                166886,    83443,     41722,     20861,    10430,    5215,
                                                2608,      1304,      652,       326,      163,      81};
  std::uint32_t angle = 0;
  if (x < 0) {
    x = -x;
    y = -y;
    angle = std::uint32_t{1} << 31;
  }
  for (std::uint32_t k = 0; k < steps.size(); ++k) {
    const std::int64_t dx = x >> k, dy = y >> k;
    const bool up = y > 0;
    x += up ? dy : -dy;
    y -= up ? dx : -dx;
    angle += up ? steps[k] : 0u - steps[k];
  }
  // A turn makes x no smaller, and the first one makes it larger unless y is zero.
  return x == 0 ? Turn{} : Turn{angle};
}

}  // namespace stiction
