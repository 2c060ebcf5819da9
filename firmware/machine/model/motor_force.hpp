// What a motor makes of what drives it: its current, or the voltage of an ideal force source.
#pragma once

#include <string_view>

#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// What drives the motor, as results and logs call it.
struct Effort {
  std::string_view name, unit;
};
inline Effort effort_of(const MotorParameters& motor) {
  return motor.driven_by_volts() ? Effort{"voltage", "V"} : Effort{"current", "A"};
}

// The force constant with which the motor makes its force: N per amplitude ampere of the whole motor, N/V of a force
// source. That of a synchronous motor is in its windings, 3/2 of one's (Mendricky 2006, 3.14); `force_constant` beside
// them is what the drive reckons with, and a data sheet rounds either (94 and 62.8 N/A, which make 94.2). The simulated
// motor has windings, so a log is read with what they make: then an exact file agrees with its own log.
inline double acting_force_constant(const MotorParameters& motor) {
  return motor.model == MotorModel::synchronous ? 1.5 * motor.phase_force_constant : motor.force_constant;
}

// The largest force (N) that inverter and motor give.
inline double largest_force(const AxisModel& axis) {
  return acting_force_constant(axis.motor) * (axis.motor.model == MotorModel::force
                                                  ? axis.inverter.voltage_limit
                                                  : axis.inverter.current_limit * axis.motor.count);
}

}  // namespace stiction::machine
