// A cam at a speed of its master: extremes in time, torque and power of the classic and of the electronic cam, and the
// limits of the axis, each with the place where it is broken and the highest speed that keeps it.
//
// A classic cam's shaft carries M_H = I w^2 y' y'', which a driven mass asks for at the output as M_D = I w^2 y''
// (Dostrasil 2014, 3.1 and 3.3). The motor of an electronic cam gives M_D and the torque of its own rotor, friction and
// weight.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host/cam/axis_load.hpp"
#include "sim/cam/characteristics.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

struct EffortFigures {
  sim::cam::Peak load;   // M_D of larger magnitude, at the output, of the load alone
  sim::cam::Peak cam;    // M_H of larger magnitude, at the master's shaft: N m, or N of a linear master
  sim::cam::Peak motor;  // of the electronic cam's motor, at the axis, with rotor, friction and weight
  double motor_rms = 0.0;
  double peak_power = 0.0;  // W, of the motor
  double energy = 0.0;      // J a cycle that the motor gives, less what it takes back
  double cam_power = 0.0;   // W, peak at the master's shaft
};

struct Limit {
  std::string name;  // "travel"
  std::string unit;  // SI, of found and allowed
  double found = 0.0;
  double allowed = 0.0;
  double place = 0.0;          // of the master, where it is found
  double highest_speed = 0.0;  // of the master, that keeps it; 0: none does, infinity: any

  bool broken() const { return found > allowed * (1.0 + 1e-12); }
};

struct Duty {
  double master_speed = 0.0;                     // rad/s or m/s
  std::array<sim::cam::Extremes, 4> extremes{};  // of position and three derivatives over time, at the master's places
  EffortFigures effort;
  std::vector<Limit> limits;

  bool broken() const;
  double highest_speed() const;  // of all limits
};

// Of `motion` at `master_speed` (above 0), on an axis with that `load`.
Duty duty_of(const sim::cam::Motion& motion, const AxisLoad& load, double master_speed);

// Without an axis: the extremes alone. `motion` at `master_speed`.
Duty duty_of(const sim::cam::Motion& motion, double master_speed);

}  // namespace stiction::host
