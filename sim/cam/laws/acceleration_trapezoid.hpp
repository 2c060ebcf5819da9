// Acceleration that is a parabola's constant one with ramps: none (the parabola), over a quarter (triangle), in lines,
// or as sin^2 (VDI 2143, part 1; Norton, Cam Design and Manufacturing Handbook). `ramp`: length of
// one ramp, of the interval.
#pragma once

#include <numbers>

#include "sim/cam/acceleration_profile.hpp"
#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

inline Curve parabola(const LawValues&) { return symmetric({polynomial_piece(0.0, 0.5, {0.0, 0.0, 2.0})}); }

inline Curve ramp_trapezoid(const LawValues& values) {
  const double ramp = value(values, "ramp");
  AccelerationProfile half;
  half.line(ramp, 0.0, 1.0).line(0.5 - 2.0 * ramp, 1.0, 1.0).line(ramp, 1.0, 0.0);
  return symmetric(half.scaled_to(0.5));
}

inline Curve triangular_acceleration(const LawValues&) { return ramp_trapezoid({{"ramp", {0.25}}}); }

// sin^2(pi u / 2 ramp) = 1/2 - 1/2 cos(pi u / ramp).
inline Curve sine_squared_trapezoid(const LawValues& values) {
  const double ramp = value(values, "ramp"), rate = std::numbers::pi / ramp, quarter = 0.5 * std::numbers::pi;
  AccelerationProfile half;
  half.sine(ramp, 0.5, rate, -quarter, 0.5).line(0.5 - 2.0 * ramp, 1.0, 1.0).sine(ramp, 0.5, rate, quarter, 0.5);
  return symmetric(half.scaled_to(0.5));
}

}  // namespace stiction::sim::cam
