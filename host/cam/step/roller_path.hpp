// Where a roller is over the cam, and where it touches: the pitch path in the cam's own frame, its normal and
// curvature, the point of contact and the pressure angle (Dostrasil 2014, chapter 4; docs/step_cams.md).
//
// With complex numbers for the plane of the cam, P = e^(i psi) (a - b e^(-i v)); the derivatives over psi follow from
// v' and v''. The point of contact is the roller's radius away from P along the normal to the left of the path, and
// moves by P' (1 - c kappa).
#pragma once

#include <complex>

#include "host/cam/step/lift.hpp"
#include "host/cam/step/mechanism.hpp"
#include "sim/number/complex.hpp"

namespace stiction::host::step {

using Point = std::complex<double>;

// The product of two vectors of the plane along each other, and the one across: a x b.
inline double dot(Point a, Point b) { return a.real() * b.real() + a.imag() * b.imag(); }
inline double cross(Point a, Point b) { return a.real() * b.imag() - a.imag() * b.real(); }

struct RollerPoint {
  double arm_angle = 0.0;  // v, rad
  double arm_speed = 0.0;  // v' over the cam's angle
  Point centre;            // m, in the cam's frame
  Point rate;              // of the centre over the cam's angle, m/rad
  Point normal;            // of length 1, from the centre to the contact
  double curvature = 0.0;  // of the pitch path, 1/m; above 0: convex
  double turning = 0.0;    // phi': of the centre's polar angle; not above 0 where the path turns back

  // Of the roller with `radius`, m.
  Point contact(double radius) const { return centre + radius * normal; }
  // How fast the contact moves over the cam's angle, m/rad. `radius` of the roller, m.
  Point contact_rate(double radius) const { return rate * (1.0 - radius * curvature); }
  // The cosine of the pressure angle with the sign of the torque that a push of the cam has: above 0 it raises v.
  // `psi`: the cam's angle, rad.
  double push(double psi) const { return -dot(normal, Point(0.0, 1.0) * sim::in_direction(1.0, psi - arm_angle)); }
};

// A roller of `mechanism` that is `base` from the line between the axes where the lift is 0, rad, at the cam's angle
// `psi`, rad, with the `lift` there.
RollerPoint roller_at(const StepMechanism& mechanism, double base, double psi, const LiftState& lift);

}  // namespace stiction::host::step
