// A drive that follows a cam through an elastic shaft, as it is simplified for an indexing table: motor and its
// controllers are a spring and a damper between set-point and rotor (Dostrasil 2014, 5.2 and 5.3), the shaft is one
// between rotor and load. With u the set-point, x the rotor and y the load, all at the load:
//   I_Z y'' = k_H (x - y) + b_H (x' - y')
//   J x''   = k_D (u - x) + b_D (u' - x') - k_H (x - y) - b_H (x' - y')
// The source has the rotor's side at the motor's shaft, behind a gear p = x/alpha: J = I_RP/p^2, k_D = k_M/p^2,
// b_D = b_M/p^2. That spring is a cascade: a P position controller of k_D/b_D over a P velocity controller of b_D, with
// full feedforward of the speed (docs/residual_vibration.md).
#pragma once

#include <stdexcept>

#include "firmware/machine/model/machine.hpp"

namespace stiction::sim::cam {

// What a machine lacks to be such a drive; what() says what was found and what was expected.
class StandError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// SI units of the axis: kg m^2, N m/rad, N m s/rad of a rotary one, kg, N/m, N s/m of a linear one.
struct ElasticDrive {
  double load_inertia = 0.0;     // I_Z
  double rotor_inertia = 0.0;    // J
  double shaft_stiffness = 0.0;  // k_H
  double shaft_damping = 0.0;    // b_H
  double drive_stiffness = 0.0;  // k_D
  double drive_damping = 0.0;    // b_D

  // Of the load on the shaft in front of a rotor that is held, rad/s.
  double clamped_frequency() const;
  // The damping ratio of that load.
  double clamped_damping() const;
  // The same drive with a load whose frequency is `factor` times as high: the stiffness goes with its square.
  ElasticDrive with_load_frequency(double factor) const;
};

// Of an `axis` with an elastic transmission and the firmware's cascade, whose velocity controller is proportional.
// Throws StandError for any other.
ElasticDrive elastic_drive_of(const machine::AxisModel& axis);

}  // namespace stiction::sim::cam
