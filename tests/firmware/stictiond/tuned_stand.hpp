// A linear axis behind a cam whose load vibrates, served with its tuner in logical time: the test rig of Dostrasil 2014
// on a radius of 100 mm, and a stiff axis beside it.
#pragma once

#include <fmt/format.h>

#include <cstring>
#include <numbers>
#include <string>

#include "tests/firmware/stictiond/served_cam.hpp"

namespace stiction::test {

inline constexpr double load_frequency = 14.481;  // Hz

// I_Z, I_R, k_H, b_H, k_M and b_M of table 2 of the source over the square of the radius; one ampere is a kilonewton.
inline const char* const tuned_stand = R"(schema = "stiction.machine/1"
name = "Linear test rig for cams"
[timing]
fast_period = "62.5 us"
slow_period = "1 ms"
[axis.X]
mass = "10.35711 kg"
travel = "600 mm"
max_velocity = "2 m/s"
max_acceleration = "60 m/s^2"
  [axis.X.transmission]
  ratio = "1/1"
  lead = "628.318530718 mm"
  motor_inertia = "8.74015910000 kg m^2"
  stiffness = "85967.506 N/m"
  damping = "23.53522 N s/m"
  [axis.X.motor]
  model = "force"
  torque_constant = "100 N m/A"
  [axis.X.inverter]
  dead_time = "125 us"
  voltage_limit = "400 V"
  current_limit = "80 A"
  [axis.X.encoder]
  on = "motor"
  increment = "0.1 um"
  velocity = "estimated"
  [axis.X.second_encoder]
  on = "load"
  increment = "26 um"
  delay = "3.3629 ms"
  noise = "5 um"
  [axis.X.position_controller]
  gain = "129.180274 1/s"
  [axis.X.velocity_controller]
  gain = "190.602957 A s/m"
  [axis.X.feedforward]
  velocity = 1.0
  current = 0.0
  [axis.X.friction]
  use = "coulomb_viscous"
    [axis.X.friction.coulomb_viscous]
    coulomb = "0 N"
    viscous = "0 N s/m"
[axis.Y]
mass = "100 kg"
travel = "600 mm"
max_velocity = "2 m/s"
max_acceleration = "60 m/s^2"
  [axis.Y.motor]
  model = "force"
  force_constant = "1000 N/A"
  [axis.Y.inverter]
  dead_time = "125 us"
  voltage_limit = "400 V"
  current_limit = "80 A"
  [axis.Y.encoder]
  increment = "0.1 um"
  velocity = "estimated"
  [axis.Y.position_controller]
  gain = "100 1/s"
  [axis.Y.velocity_controller]
  gain = "20 A s/m"
  [axis.Y.feedforward]
  velocity = 1.0
  current = 1.0
  [axis.Y.friction]
  use = "coulomb_viscous"
    [axis.Y.friction.coulomb_viscous]
    coulomb = "0 N"
    viscous = "0 N s/m"
)";

// Up in `rise` degrees, rest over `rest` of them, back, and rest over 20.
inline sim::cam::Cam stand_cam(double stroke = 50e-3, double rest = 120.0, double rise = 140.0) {
  const double degree = std::numbers::pi / 180.0;
  sim::cam::Cam cam{.name = "a", .slave = sim::cam::Coordinate::linear, .start = 0.09};
  cam.segments = {{.length = rise * degree, .stroke = stroke, .law = "3-4-5"},
                  {.length = rest * degree},
                  {.length = (340.0 - rise - rest) * degree, .stroke = -stroke, .law = "3-4-5"},
                  {.length = 20.0 * degree}};
  return cam;
}

inline Cam stand_arguments(const sim::cam::Cam& cam = stand_cam()) {
  static const std::string machine = [] {
    const std::string file =
        files().write(std::vector<std::uint8_t>(tuned_stand, tuned_stand + std::strlen(tuned_stand)));
    return file;
  }();
  return {{files().add(cam)}, "virtual", "100 rpm", machine};
}

inline std::vector<std::string> tuning_settings(double frequency, const std::vector<std::string>& more = {}) {
  std::vector<std::string> settings{fmt::format("drive.cam_tuning.frequency={:.6f} Hz", frequency),
                                    "drive.cam_tuning.damping_ratio=0.01367", "drive.cam_tuning.delay=3.3629 ms"};
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

}  // namespace stiction::test
