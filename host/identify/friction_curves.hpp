// The two measured characteristics of friction as curves, and the friction elements that have both of them
// (docs/friction_model.md). Measured tables: Mendricky 2006, Tab 5.1 and Tab 5.3. SI units.
#pragma once

#include <stdexcept>
#include <vector>

#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::host {

// Data that do not determine what was asked. what() is "what was found; what was expected".
class MissingRows : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SteadyPoint {
  double velocity;  // m/s, above 0
  double force;     // N
};

// F(v) = creeping + rise (1 - exp(-v / rise_velocity)) + viscous v for v > 0.
struct SteadyCurve {
  double creeping = 0.0;       // N, as v goes to 0
  double rise = 0.0;           // N
  double rise_velocity = 0.0;  // m/s
  double viscous = 0.0;        // N s/m
  double deviation = 0.0;      // N, rms of the points about the curve

  double at(double velocity) const;  // N
};

// Least squares; linear in all but rise_velocity, which is searched between the lowest and the highest velocity. Throws
// MissingRows for fewer than five points or a curve that falls.
SteadyCurve fit_steady_curve(const std::vector<SteadyPoint>& points);

// A carriage that coasted to rest with no force on it, then loaded with `force`.
struct PreslidingPoint {
  bool same_direction;  // as the motion before the rest
  double force;         // N, above 0
  double displacement;  // m
};

// First loading of the contact: points of Tab 5.3 B, displacement over force against the motion before, straight
// between them; the last one is where the contact breaks away.
struct PreslidingCurve {
  std::vector<double> displacement;  // m, rising
  std::vector<double> force;         // N, rising

  double coulomb() const { return force.back(); }  // N
  double force_at(double x) const;                 // N, at x (m) of at least 0
};

// Throws MissingRows for fewer than two points against the motion before, or a contact that stiffens under load (no
// sum of springs that slip does).
PreslidingCurve presliding_curve(const std::vector<PreslidingPoint>& points);

// Elements with the shape of the presliding curve and the friction of the sliding curve; `force` scales all friction,
// `displacement` all displacements. The creeping friction takes the place of the presliding curve's Coulomb friction.
sim::MaxwellSlipParameters friction_elements(const SteadyCurve& sliding, const PreslidingCurve& presliding,
                                             double force, double displacement);

}  // namespace stiction::host
