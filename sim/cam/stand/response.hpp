// How the load follows a cam whose master turns steadily, from rest at the master's 0: by the transfer function,
// exactly from step to step, and by Lagrange's equations with Runge and Kutta's fourth-order rule. Two derivations of
// one model, which check each other.
#pragma once

#include <complex>
#include <vector>

#include "sim/cam/motion.hpp"
#include "sim/cam/stand/transfer_function.hpp"

namespace stiction::sim::cam {

struct LoadState {
  double master = 0.0;    // over all cycles
  double position = 0.0;  // of the load, in the slave's unit
  double speed = 0.0;     // over time
  double acceleration = 0.0;
};

struct ResponseSettings {
  double master_speed = 0.0;  // rad/s or m/s, above 0
  int cycles = 1;
  double step = 0.25e-3;  // s, at most between two states
};

// Both begin at the start, and have a state at every joint of the motion. The transfer function is exact where the
// motion is a polynomial of the fifth degree or less in each step; other laws are replaced by the one through position,
// speed and acceleration at the ends of the step, which is 1e-12 of the stroke off. `motion` is the set-point at the
// output, `drive` what follows it.
// `settings`: speed of the master, cycles, step.
std::vector<LoadState> transfer_response(const ElasticDrive& drive, const Motion& motion,
                                         const ResponseSettings& settings);
// The same of `drive` and `motion` by Lagrange's equations, with those `settings`, and with Coulomb friction of
// `coulomb` at the rotor, which sticks where it holds it; in the unit of the drive's torque at the output.
std::vector<LoadState> lagrange_response(const ElasticDrive& drive, const Motion& motion,
                                         const ResponseSettings& settings, double coulomb = 0.0);

// The force or torque with which the drive pushes the rotor, by the transfer function; as many as transfer_response()
// has states of the same `drive`, `motion` and `settings`.
std::vector<double> transfer_forces(const ElasticDrive& drive, const Motion& motion, const ResponseSettings& settings);

// How the load's mode vibrates about the set-point at the master's place `at` of the first cycle, where the motion
// rests: the load deviates by 2 Re(c e^(pole t)) from then on. Linear in the motion. `drive`, `motion`, `master_speed`:
// as above.
std::complex<double> modal_residual(const ElasticDrive& drive, const Motion& motion, double master_speed, double at);

}  // namespace stiction::sim::cam
