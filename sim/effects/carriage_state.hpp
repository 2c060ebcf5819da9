// What an effect's force depends on, at the beginning of a step of the plant, and the body it acts on.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/plant/friction/law.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

// Displacement over which a force that follows the sign of the speed turns to it (63 %): below what a log of a feed
// axis resolves, above what the carriage moves in a step while it stands.
inline constexpr double turning_distance = 1e-6;  // m

struct CarriageState {
  double position;           // m
  double velocity;           // m/s
  double direction;          // the sign of the velocity as friction has it, -1 to 1, see SlidingDirection
  double time = 0.0;         // s, from the start
  double motor_force = 0.0;  // N, of the motor's current
  double weight = 0.0;       // N towards -x, of gravity less what balances it; for an effect of the load
};

// The sign of the velocity without its jump: d(direction)/dx = (sgn v - direction)/turning_distance along the way
// (Dahl 1968, with exponent 1), stepped exactly for the way of the step. At standstill it keeps its value as contact
// asperities do, so a force that follows it cannot chatter, and no motion but a displacement changes it. It begins at
// 0.
class SlidingDirection {
 public:
  // One step of `step` s at held velocity (m/s); returns the value at its end.
  double advance(double velocity, double step) {
    const double way = std::abs(velocity) * step;
    if (way > 0.0) value_ += (std::copysign(1.0, velocity) - value_) * one_minus_exp(way / turning_distance);
    return value_;
  }

 private:
  double value_ = 0.0;
};

// Force (N) against the motion of a friction that is proportional to the speed at this speed, `per_velocity` (N s/m).
// Limited to half of what stops the carriage in one step, so that no slope, however steep, makes it chatter. `velocity`
// in m/s; `body`: the carriage.
inline double damping_force(double per_velocity, double velocity, const Body& body) {
  return -std::min(per_velocity, 0.5 * body.mass / body.step) * velocity;
}

}  // namespace stiction::sim
