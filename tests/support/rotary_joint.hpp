// A rotary joint as a machine file describes it, and the same axis written by hand as a linear one on a circle.
#pragma once

#include <fmt/format.h>

#include <string>

namespace stiction::test {

// A small servo joint: torque source of volts, encoder of 4096 counts on the joint.
inline const std::string rotary_joint = R"(schema = "stiction.machine/1"
name = "joint"
[axis.J]
kind = "rotary"
inertia = "1.5e-3 kg m^2"
travel = "360 deg"
max_velocity = "20 rad/s"
max_acceleration = "400 rad/s^2"
[axis.J.motor]
model = "force"
torque_constant = "0.12 N m/V"
[axis.J.inverter]
dead_time = "0 us"
voltage_limit = "12 V"
[axis.J.encoder]
counts = 4096
[axis.J.position_controller]
gain = "40 1/s"
[axis.J.velocity_controller]
gain = "1.5 V s/rad"
integral_time = "20 ms"
[axis.J.friction]
use = "lugre"
[axis.J.friction.lugre]
coulomb = "0.04 N m"
viscous = "2e-3 N m s/rad"
stribeck_velocity = "0.05 rad/s"
stiffness = "60 N m/rad"
damping_ratio = 0.1
)";

// The same with an encoder that the loop's gains need to run: `counts` in a turn.
inline std::string rotary_joint_of(int counts) {
  auto text = rotary_joint;
  const std::string coarse = "counts = 4096";
  return text.replace(text.find(coarse), coarse.size(), fmt::format("counts = {}", counts));
}

// The first with every quantity taken to a circle of `radius` (m) by its definition: a way is radius times angle, a
// force torque over radius, a mass inertia over radius squared.
inline std::string joint_on_circle(double radius, int counts = 4096) {
  const double r = radius, r2 = radius * radius, turn = 6.283185307179586;
  return fmt::format(R"(schema = "stiction.machine/1"
name = "joint"
[axis.J]
mass = "{} kg"
travel = "{} m"
max_velocity = "{} m/s"
max_acceleration = "{} m/s^2"
[axis.J.motor]
model = "force"
force_constant = "{} N/V"
[axis.J.inverter]
dead_time = "0 us"
voltage_limit = "12 V"
[axis.J.encoder]
increment = "{} m"
[axis.J.position_controller]
gain = "40 1/s"
[axis.J.velocity_controller]
gain = "{} V s/m"
integral_time = "20 ms"
[axis.J.supervision]
following_error = "{} m"
[axis.J.friction]
use = "lugre"
[axis.J.friction.lugre]
coulomb = "{} N"
viscous = "{} N s/m"
stribeck_velocity = "{} m/s"
stiffness = "{} N/m"
damping_ratio = 0.1
)",
                     1.5e-3 / r2, turn * r, 20.0 * r, 400.0 * r, 0.12 / r, turn * r / counts, 1.5 / r, 0.1 * r,
                     0.04 / r, 2e-3 / r2, 0.05 * r, 60.0 / r2);
}

}  // namespace stiction::test
