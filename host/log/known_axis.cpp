#include "host/log/known_axis.hpp"

#include "firmware/machine/model/motor_force.hpp"

namespace stiction::host {

KnownAxis known_axis(const machine::AxisModel& axis) {
  KnownAxis known;
  known.mass = axis.mass;
  known.force_constant = machine::acting_force_constant(axis.motor);
  known.effort_limit = axis.motor.model == machine::MotorModel::force ? axis.inverter.voltage_limit
                                                                      : axis.inverter.current_limit * axis.motor.count;
  if (axis.motor.pole_pair_pitch > 0.0) known.pole_pair_pitch = axis.motor.pole_pair_pitch;
  return known;
}

}  // namespace stiction::host
