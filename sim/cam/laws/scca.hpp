// Acceleration of sine, constant and cosine parts (SCCA; Norton, Cam Design and Manufacturing Handbook): over the first
// half it rises as a quarter of a sine over b/2, is constant over c/2, and falls as a quarter of a cosine over d/2,
// with b + c + d = 1. (1/4, 1/2, 1/4) is the modified trapezoid, (1/4, 0, 3/4) the modified sine, (0, 0, 1) the simple
// sine and (1/2, 0, 1/2) the sloping sine.
#pragma once

#include <numbers>

#include "sim/cam/acceleration_profile.hpp"
#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

// `b`: share of the sine, `c`: of the constant part; not negative, b + c below 1.
inline Curve scca_of(double b, double c) {
  const double d = 1.0 - b - c;
  AccelerationProfile half;
  half.sine(0.5 * b, 1.0, std::numbers::pi / b, 0.0).line(0.5 * c, 1.0, 1.0);
  half.sine(0.5 * d, 1.0, std::numbers::pi / d, 0.5 * std::numbers::pi);
  return symmetric(half.scaled_to(0.5));
}

inline Curve simple_sine(const LawValues&) { return scca_of(0.0, 0.0); }
inline Curve modified_trapezoid(const LawValues&) { return scca_of(0.25, 0.5); }
inline Curve modified_sine(const LawValues&) { return scca_of(0.25, 0.0); }

// Throws CamError where no cosine part is left.
inline Curve scca(const LawValues& values) {
  const double b = value(values, "sine"), c = value(values, "constant");
  if (!(b + c <= 0.999))
    throw CamError("law scca: found sine and constant parts that fill the interval; expected sine + constant <= 0.999");
  return scca_of(b, c);
}

}  // namespace stiction::sim::cam
