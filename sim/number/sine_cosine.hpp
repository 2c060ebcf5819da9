// Sine and cosine of one angle, for the motor of every plant step and the set-points of every tick.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "sim/number/sine_table.hpp"

namespace stiction::sim {

// Within 3e-16 for |angle| <= 1e6 rad; beyond that it loses accuracy, and what is not a number gives none. 40
// instructions, where sincos() of glibc takes 131, and inline: a call costs the loop around it its registers.
[[gnu::always_inline]] inline SineCosine sine_cosine(double angle) {
  // The nearest direction: adding 1.5 * 2^52 leaves no room for a fraction.
  constexpr double no_fraction = 0x1.8p52;
  const double shifted = angle * (detail::directions / (2.0 * std::numbers::pi)) + no_fraction;
  const double turned = shifted - no_fraction;
  const auto [s, c] = detail::direction[std::bit_cast<std::uint64_t>(shifted) % detail::directions];
  // The angle of a direction in two parts; the first has 26 bits, so that its product with up to 2^27 is exact.
  constexpr double first = 0x1.921fb58p-7, rest = -0x1.dde973dcb3b3ap-34;
  const double r = (angle - turned * first) - turned * rest;

  // Minimax polynomials up to half a direction to both sides: 7e-20 and 3e-18.
  const double z = r * r;
  const double sine = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0));
  const double versine = z * (-0.4999999999988926 + z * 0.04166658823009808);  // cos r - 1
  return {s + (c * sine + s * versine), c + (c * versine - s * sine)};
}

}  // namespace stiction::sim
