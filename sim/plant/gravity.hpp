// The weight of an axis less what balances it: a constant force towards -x, or of a rotary axis a moment that follows
// the sine of the angle from the rest below (Sciavicco, Siciliano 2000, chapter 4).
#pragma once

#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/carriage_force.hpp"

namespace stiction::sim {

// N towards -x at `position` (m) of an axis with the table [gravity].
inline double gravity_force(const machine::AxisModel& axis, double position) {
  const machine::GravityParameters& gravity = *axis.gravity;
  const double weight = gravity.force - gravity.counterweight.value_or(0.0);
  return axis.coordinate.rotary() ? weight * std::sin((position - gravity.zero) / axis.coordinate.radius) : weight;
}

class Gravity final : public CarriageForce {
 public:
  // `step`: of the plant, s; the force is that in its middle.
  Gravity(const machine::AxisModel& axis, double step) : axis_(axis), half_step_(0.5 * step) {}

  double force(const CarriageState& state) const override {
    return -gravity_force(axis_, state.position + half_step_ * state.velocity);
  }

 private:
  machine::AxisModel axis_;
  double half_step_;
};

}  // namespace stiction::sim
