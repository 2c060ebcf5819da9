// What a motor makes of what drives it: its current, or the voltage of an ideal force source.
#pragma once

#include <string_view>

#include "sim/model/machine.hpp"

namespace stiction::sim {

// What drives the motor, as results and logs call it.
struct Effort {
  std::string_view name, unit;
};
inline Effort effort_of(const Motor& motor) {
  return motor.model == MotorModel::force ? Effort{"voltage", "V"} : Effort{"current", "A"};
}

// The largest force (N) that inverter and motor give.
inline double largest_force(const Axis& axis) {
  return axis.motor.force_constant * (axis.motor.model == MotorModel::force
                                          ? axis.inverter.voltage_limit
                                          : axis.inverter.current_limit * axis.motor.count);
}

}  // namespace stiction::sim
