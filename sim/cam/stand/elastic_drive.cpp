#include "sim/cam/stand/elastic_drive.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stiction::sim::cam {

double ElasticDrive::clamped_frequency() const { return std::sqrt(shaft_stiffness / load_inertia); }

double ElasticDrive::clamped_damping() const { return 0.5 * shaft_damping / std::sqrt(shaft_stiffness * load_inertia); }

ElasticDrive ElasticDrive::with_load_frequency(double factor) const {
  ElasticDrive changed = *this;
  changed.shaft_stiffness *= factor * factor;
  return changed;
}

ElasticDrive elastic_drive_of(const machine::AxisModel& axis) {
  if (!axis.elastic())
    throw StandError(fmt::format(
        "axis {}: found no transmission.stiffness; expected it, since a stiff axis has no residual vibration",
        axis.name));
  if (!axis.cascaded() || axis.motor.driven_by_volts())
    throw StandError(
        fmt::format("axis {}: found a drive that is not the firmware's cascade over a current; expected that one, "
                    "whose gains are the drive's spring and damper",
                    axis.name));
  if (axis.velocity_controller.integral_time)
    throw StandError(
        fmt::format("axis {}: found velocity_controller.integral_time; expected a proportional velocity controller, "
                    "which is what a spring and a damper describe",
                    axis.name));
  // The axis as a linear one of a radius r (machine.hpp): masses and the like are those of the rotary axis over r^2.
  const double square = axis.coordinate.rotary() ? axis.coordinate.radius * axis.coordinate.radius : 1.0;
  ElasticDrive drive;
  drive.load_inertia = (axis.mass - axis.motor_mass) * square;
  drive.rotor_inertia = axis.motor_mass * square;
  drive.shaft_stiffness = *axis.transmission->stiffness * square;
  drive.shaft_damping = axis.transmission->damping.value_or(0.0) * square;
  drive.drive_damping = axis.velocity_controller.gain * axis.motor.force_constant * square;
  drive.drive_stiffness = axis.position_controller.gain * drive.drive_damping;
  return drive;
}

}  // namespace stiction::sim::cam
