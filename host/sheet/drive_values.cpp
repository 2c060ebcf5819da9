#include "host/sheet/drive_values.hpp"

#include <cmath>
#include <numbers>

namespace stiction::host {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr double fast_period = 62.5e-6, slow_period = 1e-3, dead_time = 125e-6;  // s
constexpr double standard_gravity = 9.80665;                                     // m/s^2

bool has(const SheetAnswers& answers, std::string_view name, std::string_view what) {
  return answer_to(answers, name) == what;
}
bool rotary(const SheetAnswers& answers) { return has(answers, "kind", "rotary"); }
bool has_shaft(const SheetAnswers& answers) { return rotary(answers) || !has(answers, "transmission", "direct"); }

}  // namespace

MotorValues motor_values(const SheetAnswers& answers) {
  MotorValues motor;
  motor.ampere_factor = has(answers, "amperes", "rms") ? std::numbers::sqrt2 : 1.0;
  const bool line = has(answers, "between", "line");
  // Between two lines two windings are in series.
  motor.line_factor = line ? 0.5 : 1.0;
  motor.resistance = motor.line_factor * sheet_quantity(answers, "resistance", "Ohm");
  motor.inductance = motor.line_factor * sheet_quantity(answers, "inductance", "H");
  motor.current_limit = motor.ampere_factor * sheet_quantity(answers, "current-limit", "A");
  motor.supply = sheet_quantity(answers, "supply", "V");
  motor.constant = (has_shaft(answers) ? sheet_quantity(answers, "torque-constant", "N m/A")
                                       : sheet_quantity(answers, "force-constant", "N/A")) /
                   motor.ampere_factor;
  // Three windings with sine currents make 3/2 of what one makes; the energy that each converts makes its voltage.
  motor.emf = motor.constant / 1.5;
  if (has_shaft(answers) && !answer_to(answers, "voltage-constant").empty())
    motor.emf = sheet_quantity(answers, "voltage-constant", "V s/rad") *
                (has(answers, "volts", "rms") ? std::numbers::sqrt2 : 1.0) / (line ? std::numbers::sqrt3 : 1.0);
  return motor;
}

AxisValues axis_values(const SheetAnswers& answers, const MotorValues& motor) {
  AxisValues axis;
  axis.mass = sheet_quantity(answers, "load", rotary(answers) ? "kg m^2" : "kg");
  if (has_shaft(answers)) {
    if (has(answers, "transmission", "screw")) axis.screw = sheet_quantity(answers, "lead", "m") / turn;
    if (has(answers, "transmission", "belt")) axis.screw = sheet_quantity(answers, "pulley", "m") / turn;
    const double out = axis.screw > 0.0 ? axis.screw : 1.0;
    axis.way = has(answers, "transmission", "direct") ? 1.0 : out / ratio_in(answer_to(answers, "ratio"));
    axis.mass += sheet_quantity(answers, "motor-inertia", "kg m^2") / (axis.way * axis.way);
    if (axis.screw > 0.0) axis.mass += sheet_quantity(answers, "screw-inertia", "kg m^2") / (axis.screw * axis.screw);
  }
  axis.force_per_ampere = motor.constant / axis.way;
  return axis;
}

ControllerValues controller_values(const MotorValues& motor, const AxisValues& axis) {
  constexpr double ratio = 3.0;  // of the symmetrical optimum: 53 degrees of phase margin
  ControllerValues c;
  const double current_lag = dead_time + 1.5 * fast_period;
  c.current_gain = motor.inductance / (2.0 * current_lag);
  c.current_time = motor.inductance / motor.resistance;
  const double velocity_lag = 2.0 * current_lag + fast_period + 0.5 * slow_period;
  c.velocity_gain = axis.mass / (axis.force_per_ampere * ratio * velocity_lag);
  c.velocity_time = ratio * ratio * velocity_lag;
  c.position_gain = 1.0 / (4.0 * ratio * velocity_lag);
  return c;
}

FrictionValues friction_values(const SheetAnswers& answers, const MotorValues& motor, const AxisValues& axis) {
  FrictionValues f;
  const bool turns = rotary(answers);
  f.estimated = answer_to(answers, "coulomb").empty();
  if (!f.estimated) {
    f.coulomb = sheet_quantity(answers, "coulomb", turns ? "N m" : "N");
  } else if (turns) {
    f.coulomb = sheet_quantity(answers, "friction-share", "1") * axis.force_per_ampere * motor.current_limit;
  } else {
    const double carriages = sheet_quantity(answers, "carriages", "1");
    const double on_guides = standard_gravity * sheet_quantity(answers, "load", "kg") +
                             sheet_quantity(answers, "attraction", "N") +
                             carriages * sheet_quantity(answers, "preload", "N");
    f.coulomb = sheet_quantity(answers, "guide-coefficient", "1") * on_guides +
                carriages * sheet_quantity(answers, "seal-drag", "N");
    if (axis.screw > 0.0) f.coulomb += sheet_quantity(answers, "drag-torque", "N m") / axis.screw;
  }
  // At full speed lubricated guides and bearings drag about twice as much as at low speed.
  f.viscous = f.coulomb / sheet_quantity(answers, "max-velocity", turns ? "rad/s" : "m/s");
  return f;
}

}  // namespace stiction::host
