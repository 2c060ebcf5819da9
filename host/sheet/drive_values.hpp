// What a machine file needs of data sheets, in amplitude amperes and of one winding, and controllers by rules.
#pragma once

#include <optional>

#include "host/sheet/questions.hpp"

namespace stiction::host {

// SI units; at the motor: of its shaft, or of a linear motor's slider.
struct MotorValues {
  double resistance = 0.0, inductance = 0.0;      // Ohm, H of one winding
  double constant = 0.0;                          // N m/A or N/A of the whole motor, per amplitude ampere; or per volt
  double emf = 0.0;                               // V s/rad or V s/m of one winding, amplitude
  double current_limit = 0.0, supply = 0.0;       // A amplitude, V; 0: not known, of a source of force
  double line_factor = 1.0, ampere_factor = 1.0;  // from the sheet's to these
  bool source = false, per_volt = false;          // a source of force: no windings; constant per volt
};
MotorValues motor_values(const SheetAnswers& answers);

// What is moved, at the axis: way (m, of a rotary axis rad) of a motor's radian, 1 of a direct drive; the whole mass
// (inertia); force (torque) per amplitude ampere.
struct AxisValues {
  double way = 1.0;    // of a motor's radian
  double screw = 0.0;  // of a radian of screw or pulley; 0: none
  double mass = 0.0, force_per_ampere = 0.0;
};
AxisValues axis_values(const SheetAnswers& answers, const MotorValues& motor);

// The way alone, which needs no mass; of complete answers on the transmission.
double way_of(const SheetAnswers& answers);

// Cascade for the shipped periods, 62.5 us and 1 ms: the current loop by the magnitude optimum, the velocity loop by
// the symmetrical optimum (Leonhard 2001).
struct ControllerValues {
  double current_gain = 0.0, current_time = 0.0;    // V/A, s
  double velocity_gain = 0.0, velocity_time = 0.0;  // A s/m or A s/rad, s
  double position_gain = 0.0;                       // 1/s
};
ControllerValues controller_values(const MotorValues& motor, const AxisValues& axis);

// Coulomb (N or N m) and viscous friction (N s/m or N m s/rad).
struct FrictionValues {
  double coulomb = 0.0, viscous = 0.0;
  bool estimated = false;          // the Coulomb friction is none of the answers
  bool estimated_viscous = false;  // nor the viscous
};
// `answers` with the friction or what it is estimated from; `motor`, `axis`: of these answers; `effort` (A amplitude,
// V): what takes the place of the motor's limit where that is not known, 0 where nothing does.
FrictionValues friction_values(const SheetAnswers& answers, const MotorValues& motor, const AxisValues& axis,
                               double effort = 0.0);

}  // namespace stiction::host
