// Sine and cosine of one angle, for the motor of every plant step and the set-points of every tick.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace stiction::sim {

struct SineCosine {
  double sine;
  double cosine;
};

namespace detail {

// 8 KiB. With half as many the polynomials need a term more.
inline constexpr std::size_t directions = 512;

// Sine and cosine of every direction, counter-clockwise from 0. The series of half a turn loses 1e-18 in long double.
constexpr std::array<SineCosine, directions> sines_of_directions() {
  std::array<SineCosine, directions> table{};
  for (std::size_t k = 0; k < directions; ++k) {
    const auto turned = static_cast<long double>(k) - (k < directions / 2 ? 0 : directions);
    const long double angle = turned * (2 * std::numbers::pi_v<long double> / directions);
    long double term = 1.0L, sine = 0.0L, cosine = 1.0L;
    for (int n = 1; n < 36; ++n) {
      term *= angle / n;
      (n % 2 == 1 ? sine : cosine) += n % 4 < 2 ? term : -term;
    }
    table[k] = {static_cast<double>(sine), static_cast<double>(cosine)};
  }
  return table;
}
inline constexpr auto direction = sines_of_directions();

}  // namespace detail

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
