// Arc tangent, arc sine and arc cosine without a library of mathematics, so that they have the same bits wherever they
// are compiled.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "sim/number/arithmetic.hpp"

namespace stiction::sim {

namespace detail {

// atan(k / 16), rounded; the sum of a series of 50 digits.
// clang-format off
inline constexpr std::array<double, 17> sixteenths{
    0x0p+0, 0x1.ff55bb72cfdeap-5, 0x1.fd5ba9aac2f6ep-4, 0x1.7b97b4bce5b02p-3,
    0x1.f5b75f92c80ddp-3, 0x1.362773707ebccp-2, 0x1.6f61941e4def1p-2, 0x1.a64eec3cc23fdp-2,
    0x1.dac670561bb4fp-2, 0x1.0657e94db30dp-1, 0x1.1e00babdefeb4p-1, 0x1.345f01cce37bbp-1,
    0x1.4978fa3269ee1p-1, 0x1.5d58987169b18p-1, 0x1.700a7c5784634p-1, 0x1.819d0b7158a4dp-1,
    0x1.921fb54442d18p-1};
// clang-format on

// Of a quotient from 0 to 1, 0 <= above <= below and below > 0. The nearest sixteenth c is taken out by
// atan q = atan c + atan((q - c) / (1 + q c)); the rest is at most 1/32, of which the term t^13/13 is 7e-20.
constexpr double arc_of_quotient(double above, double below) {
  const double q = above / below;
  if (!(q <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(16.0 * q + 0.5);
  const double c = static_cast<double>(k) / 16.0;
  const double t = (above - c * below) / (below + c * above), z = t * t;
  const double series = 1.0 / 3.0 - z * (1.0 / 5.0 - z * (1.0 / 7.0 - z * (1.0 / 9.0 - z * (1.0 / 11.0))));
  return sixteenths[k] + (t - t * z * series);
}

}  // namespace detail

// The angle of the place (`x`, `y`) from the direction of x, from -pi to pi rad, within 2 units of the last place; of
// (0, 0) it is 0 with the sign of y, or half a turn where x is -0, as atan2() has it. Both at most 1e300; what
// is not a number gives none.
constexpr double arc_tangent(double y, double x) {
  constexpr double quarter = 0x1.921fb54442d18p+0, quarter_rest = 0x1.1a62633145c07p-54;
  const double up = absolute(y), along = absolute(x);
  double angle = 0.0;
  if (up <= along)
    angle = along > 0.0 ? detail::arc_of_quotient(up, along) : 0.0;
  else
    angle = quarter - (detail::arc_of_quotient(along, up) - quarter_rest);
  if (copy_sign(1.0, x) < 0.0) angle = 2.0 * quarter - (angle - 2.0 * quarter_rest);
  return copy_sign(angle, y);
}

// From 0 to pi rad for `cosine` from -1 to 1, within 4 units of the last place; the differences from 1 are exact where
// they are small.
inline double arc_cosine(double cosine) {
  return 2.0 * arc_tangent(square_root(1.0 - cosine), square_root(1.0 + cosine));
}

// From -pi/2 to pi/2 rad for `sine` from -1 to 1, within 3 units of the last place.
inline double arc_sine(double sine) { return arc_tangent(sine, square_root((1.0 - sine) * (1.0 + sine))); }

}  // namespace stiction::sim
