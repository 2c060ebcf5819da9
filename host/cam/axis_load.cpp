#include "host/cam/axis_load.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/machine/model/motor_force.hpp"
#include "sim/number/sine_cosine.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {

double AxisLoad::effort(double position, double speed, double acceleration) const {
  const double direction = speed > 0.0 ? 1.0 : speed < 0.0 ? -1.0 : 0.0;
  const double down =
      kind == sim::cam::Coordinate::rotary ? weight * sim::sine_cosine(position - weight_zero).sine : weight;
  return inertia() * acceleration + viscous * speed + coulomb * direction + down;
}

double AxisLoad::effort_left() const { return std::max(0.0, largest_effort - coulomb - std::fabs(weight)); }

AxisLoad load_of(const machine::AxisModel& axis) {
  // A rotary axis is a linear one on a circle in the model (coordinate.hpp).
  const double r = axis.coordinate.rotary() ? axis.coordinate.radius : 1.0;
  AxisLoad load;
  load.axis = axis.name;
  load.kind = axis.coordinate.rotary() ? sim::cam::Coordinate::rotary : sim::cam::Coordinate::linear;
  load.load = axis.load_mass * r * r;
  load.rotor = (axis.mass - axis.load_mass) * r * r;
  load.coulomb = sim::coulomb_of(axis.friction) * r;
  load.viscous = sim::viscous_of(axis.friction) * r * r;
  if (axis.gravity) {
    load.weight = (axis.gravity->force - axis.gravity->counterweight.value_or(0.0)) * r;
    load.weight_zero = axis.gravity->zero / r;
  }
  const double force = machine::largest_force(axis);
  if (force > 0.0 && force < machine::unlimited) load.largest_effort = force * r;
  if (!axis.modulo) load.travel = axis.travel / r;
  load.max_speed = axis.max_velocity / r;
  load.max_acceleration = axis.max_acceleration / r;
  if (axis.elastic() && axis.load_mass > 0.0) {
    const double omega = std::sqrt(*axis.transmission->stiffness / axis.load_mass);
    load.frequency = omega / (2.0 * std::numbers::pi);
    load.damping_ratio = axis.transmission->damping.value_or(0.0) / (2.0 * axis.load_mass * omega);
  }
  return load;
}

}  // namespace stiction::host
