// What a cam needs to know of the axis that follows it, in the slave's own unit: kg m^2, N m and rad of a rotary axis,
// kg, N and m of a linear one.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

struct AxisLoad {
  std::string axis;
  sim::cam::Coordinate kind = sim::cam::Coordinate::rotary;
  double load = 0.0;   // inertia or mass of the load alone
  double rotor = 0.0;  // of the motor and what turns with it, at the axis
  double coulomb = 0.0;
  double viscous = 0.0;
  double weight = 0.0;       // largest moment of gravity, or its constant force, towards -x
  double weight_zero = 0.0;  // angle of rest below
  double largest_effort = std::numeric_limits<double>::infinity();  // torque or force of motor and inverter
  double travel = std::numeric_limits<double>::infinity();
  double max_speed = std::numeric_limits<double>::infinity();
  double max_acceleration = std::numeric_limits<double>::infinity();
  std::optional<double> frequency;  // Hz, of the load on an elastic shaft in front of a motor that is held
  double damping_ratio = 0.0;       // of it

  double inertia() const { return load + rotor; }
  // What the motor gives, at the axis, at this `position`, `speed` and `acceleration` of it, in its unit over s.
  double effort(double position, double speed, double acceleration) const;
  // Of the largest effort what Coulomb friction and the weight leave for accelerations.
  double effort_left() const;
  // "N m", "rad", or "N", "m".
  const char* effort_unit() const { return kind == sim::cam::Coordinate::rotary ? "N m" : "N"; }
  const char* unit() const { return kind == sim::cam::Coordinate::rotary ? "rad" : "m"; }
};

AxisLoad load_of(const machine::AxisModel& axis);

}  // namespace stiction::host
