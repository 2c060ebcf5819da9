// A single radial cam whose one roller a spring holds on it: contact force, Hertz pressure, and the speed at which the
// roller lifts off.
//
// The arm has F b cos mu = s (I w^2 v'' + M sgn v') + T0 + k s (v - v0): s is the way in which the cam pushes it, T0
// and k are preload and rate of the spring, v0 where the lift is 0, M the load's torque. F falls below 0 first where
// the spring's torque over that of the inertia is the least, which gives the speed in closed form at each angle.
#pragma once

#include <string>
#include <vector>

#include "host/cam/step/synthesis.hpp"

namespace stiction::host::step {

struct SpringContact {
  double psi = 0.0;             // rad, angle of the cam
  double pressure_angle = 0.0;  // rad
  double curvature = 0.0;       // of the profile, 1/m; above 0: convex
  double force = 0.0;           // N; below 0 the roller has lifted off
  double pressure = 0.0;        // Pa
  double input_torque = 0.0;    // N m, at the cam shaft in its direction
};

struct SpringCam {
  StepLift lift;
  StepProfile profile;
  std::vector<SpringContact> contacts;  // over a turn, in equal steps of the cam's angle, at the project's speed
  double lift_off_speed = 0.0;          // rad/s; infinite: at none
  double lift_off_psi = 0.0;            // rad, where the roller lifts off first
  double speed_for_pressure = 0.0;      // rad/s, that keeps the load's largest pressure; infinite where none is stated
  std::vector<std::string> notes;
};

// Of `project`, which has a spring, one roller, and a lift that returns. Throws sim::cam::CamError for what cannot be
// built, with the place and what would help; a roller that lifts off at the project's speed is no error.
SpringCam synthesize_spring_cam(const StepProject& project);

}  // namespace stiction::host::step
