// Kinetostatics of a step cam: what the contacts, the shafts and their bearings carry, and the Hertz pressure.
//
// The carousel needs M = I w^2 v'' and the load's torque; its cam shaft gives M v' (Dostrasil 2014, 3.1 and 3.3).
// Rigid, the contact that pushes the way of M carries it alone. Elastic, each contact is a spring: the axes are nearer
// by the preload, the carousel turns by what balances the torque, and two or three contacts share it. Line contact
// after Hertz: p = sqrt[(F / pi l)(1/r1 + 1/r2) / ((1 - m1^2)/E1 + (1 - m2^2)/E2)].
#pragma once

#include <optional>
#include <vector>

#include "host/cam/step/contacts.hpp"

namespace stiction::host::step {

struct Material {
  double modulus = 0.0;  // Pa
  double poisson = 0.0;
};

struct StepLoad {
  double inertia = 0.0;    // kg m^2, of the carousel and what it carries
  double torque = 0.0;     // N m, that the load takes against the motion
  double speed = 0.0;      // rad/s, of the cam
  double preload = 0.0;    // m, by which the axes are nearer than the profiles are made for
  double stiffness = 0.0;  // N/m, of a roller on its cam; 0: rigid
  Material cam, roller;
  std::optional<double> largest_pressure;  // Pa, that the user states
};

struct ContactForce {
  Contact contact;
  double force = 0.0;     // N
  double pressure = 0.0;  // Pa
};

struct StepForces {
  double psi = 0.0;
  double output_torque = 0.0;  // N m, M_D with the load's, in the direction of v
  double input_torque = 0.0;   // N m, at the cam shaft in its direction
  double bearing = 0.0;        // N, of either shaft
  std::vector<ContactForce> contacts;
};

// At the cam's angle of `contacts`, rad; `mechanism`, `lift` and `load` are the drive's. Elastic where the load has a
// stiffness: `contacts` then hold rollers with gaps too, which the preload may close.
StepForces forces_at(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                     const ContactSet& contacts);

// The Hertz pressure in Pa of a roller of `radius`, m, with the force `force`, N, over `width`, m, on a profile with
// the `curvature`, 1/m, above 0 where it is convex; `cam` and `roller`: their materials.
double hertz_pressure(double force, double width, double radius, double curvature, const Material& cam,
                      const Material& roller);

struct ForcePeaks {
  double output_torque = 0.0, input_torque = 0.0, input_power = 0.0, force = 0.0, pressure = 0.0, bearing = 0.0;
  double force_psi = 0.0, pressure_psi = 0.0, pressure_angle = 0.0;  // rad; the last one where the pressure is highest
  double least_force = 0.0;  // N, of the needed contacts, where the drive is elastic
};
// The peaks of `forces` over a turn at the cam's `speed`, rad/s.
ForcePeaks peaks_of(const std::vector<StepForces>& forces, double speed);

// The highest speed of the cam, rad/s, at which no contact has more than the load's largest pressure; infinite where
// none is stated, 0 where the drive at rest has more. `mechanism`, `lift` and `load`: of the drive; `sets`: its
// contacts over a turn.
double speed_for_pressure(const StepMechanism& mechanism, const StepLift& lift, StepLoad load,
                          const std::vector<ContactSet>& sets);
// The highest one at which every needed contact of an elastic drive is pressed, rad/s; 0 without preload. `mechanism`,
// `lift`, `load` and `sets` as above.
double speed_before_lift_off(const StepMechanism& mechanism, const StepLift& lift, StepLoad load,
                             const std::vector<ContactSet>& sets);

}  // namespace stiction::host::step
