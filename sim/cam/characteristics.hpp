// What makes laws comparable: peaks of speed, acceleration, jerk and torque of the unit law (VDI 2143, part 1: Cv, Ca,
// Cj, C_M), jumps, and the residual vibration after it.
#pragma once

#include <array>
#include <vector>

#include "sim/cam/curve.hpp"
#include "sim/cam/law.hpp"

namespace stiction::sim::cam {

// A peak of a derivative, or of a product of two.
struct Peak {
  double value = 0.0;
  double place = 0.0;  // of the master
};

struct Extremes {
  Peak lowest, highest;

  // The one of larger magnitude, without its sign.
  double magnitude() const { return std::max(absolute(lowest.value), absolute(highest.value)); }
};

// Lowest and highest values of the derivative of `order` of `curve`, both sides of joints included. Zeros of the next
// derivative are bracketed by 32 samples a wave and piece, and found by bisection to the last place.
Extremes extremes(const Curve& curve, int order);

// The same of y' y'', of which a driven mass makes the torque at the master's shaft.
Extremes torque_extremes(const Curve& curve);

// What a step of each derivative is compared with: its largest magnitude, and of the position its range. A derivative
// that is zero but for rounding, of a dwell or a line, has no peak: a thousandth of a wave over the whole stands in.
std::array<double, 4> derivative_sizes(const Curve& curve);

// A step of the derivative of `order` at a place: value behind it minus value before it.
struct Jump {
  double place;
  int order;  // 0: position
  double height;
};

// Steps of the derivatives 0 to 3 of `curve` at its joints, each larger than `tolerance` of that derivative's peak; the
// tolerance is without unit.
std::vector<Jump> inner_jumps(const Curve& curve, double tolerance = 1e-9);

// The unit law `curve` of `law` at its ends, between what its task asks for: speed is 0 at an end at rest and at a
// reversal, acceleration at rest and at constant speed. Jerk steps at every end at rest that does not begin with zero
// jerk. `values`: with which the curve was made. `tolerance`: a smaller
// value is none, in the unit law's own units.
std::vector<Jump> end_jumps(const Law& law, const LawValues& values, const Curve& curve, double tolerance = 1e-9);

struct Characteristics {
  double speed = 0.0;         // Cv
  double acceleration = 0.0;  // Ca+
  double deceleration = 0.0;  // Ca-, negative
  double jerk = 0.0;          // Cj, its finite part
  double torque = 0.0;        // C_M = max |y' y''|
  std::vector<Jump> jumps;    // at the ends and inside, in the order of the master

  // Whether position, speed or acceleration jumps.
  bool jerks_without_bound() const;
};

// Of the unit law `curve`, which was made of `law` with `values`.
Characteristics characteristics(const Law& law, const LawValues& values, const Curve& curve);

// The undamped residual amplitude over the stroke, one side, of an oscillator whose base follows the unit law:
// A(r) = |integral of f'' e^(-i 2 pi r x)| / (2 pi r), with `r` natural periods in the rise, above 0. Steps of speed
// add their impulse; an end counts as at rest, as it is in the table of docs/cam.md. By quadrature over each piece.
double residual_amplitude(const Curve& curve, double r);

}  // namespace stiction::sim::cam
