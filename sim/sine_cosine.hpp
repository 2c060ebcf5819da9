// Sine and cosine of one angle, for the motor of every plant step and the set-points of every tick.
#pragma once

#include <bit>
#include <cstdint>
#include <numbers>

namespace stiction::sim {

struct SineCosine {
  double sine;
  double cosine;
};

// Within 3e-16 for |angle| <= 1e6 rad; beyond that it loses accuracy, and what is not a number gives none. 62
// instructions, where sincos() of glibc takes 131, and inline: a call costs the loop around it its registers.
inline SineCosine sine_cosine(double angle) {
  // The nearest whole number of quarter turns: adding 1.5 * 2^52 leaves no room for a fraction.
  constexpr double no_fraction = 0x1.8p52;
  const double shifted = angle * (2.0 / std::numbers::pi) + no_fraction;
  const double quarters = shifted - no_fraction;
  const auto quadrant = std::bit_cast<std::uint64_t>(shifted);
  // pi/2 in two parts; the first has 33 bits, so that its product with up to 2^20 quarters is exact.
  constexpr double first = 0x1.921fb544p0, rest = 0x1.0b4611a626331p-34;
  const double r = (angle - quarters * first) - quarters * rest;

  // Minimax polynomials over an eighth of a turn to both sides: 4e-18 and 1e-16.
  const double z = r * r;
  const double s =
      r + r * z *
              (-0.1666666666666663 +
               z * (0.008333333333322108 +
                    z * (-0.0001984126982958018 +
                         z * (2.7557313618021765e-06 + z * (-2.5050747218823076e-08 + z * 1.5896197668768926e-10)))));
  const double c = 1.0 - 0.5 * z +
                   z * z *
                       (0.04166666666659647 +
                        z * (-0.0013888888877602655 +
                             z * (2.480158070332401e-05 + z * (-2.755552238612004e-07 + z * 2.064507235751085e-09))));

  switch (quadrant & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace stiction::sim
