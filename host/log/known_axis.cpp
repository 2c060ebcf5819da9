#include "host/log/known_axis.hpp"

#include "firmware/machine/model/motor_force.hpp"

namespace stiction::host {

KnownAxis known_axis(const machine::AxisModel& axis) {
  KnownAxis known;
  const auto own = [&](double value, std::string_view unit) { return axis.coordinate.own(unit).from_linear(value); };
  known.mass = own(axis.mass, "kg");
  known.force_constant = own(machine::acting_force_constant(axis.motor), "N/A");
  known.effort_limit =
      axis.motor.driven_by_volts() ? axis.inverter.voltage_limit : axis.inverter.current_limit * axis.motor.count;
  if (axis.motor.pole_pair_pitch > 0.0) known.pole_pair_pitch = own(axis.motor.pole_pair_pitch, "m");
  if (axis.gravity && axis.coordinate.rotary())
    known.weight = {own(axis.gravity->force - axis.gravity->counterweight.value_or(0.0), "N"),
                    own(axis.gravity->zero, "m")};
  return known;
}

}  // namespace stiction::host
