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
double given_or_zero(const SheetAnswers& answers, std::string_view name, std::string_view unit) {
  return answer_to(answers, name).empty() ? 0.0 : sheet_quantity(answers, name, unit);
}

// Way (m, of a rotary axis rad) of a radian of the screw or pulley; 0: none.
double screw_of(const SheetAnswers& answers) {
  if (has(answers, "transmission", "screw")) return sheet_quantity(answers, "lead", "m") / turn;
  return has(answers, "transmission", "belt") ? sheet_quantity(answers, "pulley", "m") / turn : 0.0;
}

}  // namespace

MotorValues motor_values(const SheetAnswers& answers) {
  MotorValues motor;
  motor.ampere_factor = has(answers, "amperes", "rms") ? std::numbers::sqrt2 : 1.0;
  motor.source = is_force_source(answers);
  motor.per_volt = driven_by_volts(answers);
  motor.current_limit = motor.ampere_factor * given_or_zero(answers, "current-limit", "A");
  motor.supply = given_or_zero(answers, "supply", "V");
  const char* name = has_shaft(answers) ? "torque-constant" : "force-constant";
  if (motor.per_volt) {
    motor.constant = sheet_quantity(answers, name, has_shaft(answers) ? "N m/V" : "N/V");
    return motor;
  }
  motor.constant = sheet_quantity(answers, name, has_shaft(answers) ? "N m/A" : "N/A") / motor.ampere_factor;
  if (motor.source) return motor;
  const bool line = has(answers, "between", "line");
  // Between two lines two windings are in series. Some sheets give the voltage between lines, the rest of a winding.
  const bool apart = !answer_to(answers, "winding-between").empty();
  motor.line_factor = has(answers, apart ? "winding-between" : "between", "line") ? 0.5 : 1.0;
  motor.resistance = motor.line_factor * sheet_quantity(answers, "resistance", "Ohm");
  motor.inductance = motor.line_factor * sheet_quantity(answers, "inductance", "H");
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
  axis.way = way_of(answers);
  axis.screw = screw_of(answers);
  if (has_shaft(answers) && !(motor.source && has(answers, "transmission", "direct"))) {
    axis.mass += sheet_quantity(answers, "motor-inertia", "kg m^2") / (axis.way * axis.way);
    if (axis.screw > 0.0) axis.mass += sheet_quantity(answers, "screw-inertia", "kg m^2") / (axis.screw * axis.screw);
  }
  axis.force_per_ampere = motor.constant / axis.way;
  return axis;
}

double way_of(const SheetAnswers& answers) {
  if (has(answers, "transmission", "direct")) return 1.0;
  const double screw = screw_of(answers);
  return (screw > 0.0 ? screw : 1.0) / ratio_in(answer_to(answers, "ratio"));
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

FrictionValues friction_values(const SheetAnswers& answers, const MotorValues& motor, const AxisValues& axis,
                               double effort) {
  FrictionValues f;
  const bool turns = rotary(answers);
  f.estimated = answer_to(answers, "coulomb").empty();
  if (!f.estimated) {
    f.coulomb = sheet_quantity(answers, "coulomb", turns ? "N m" : "N");
  } else if (turns) {
    const double limit = motor.per_volt ? motor.supply : motor.current_limit;
    f.coulomb = sheet_quantity(answers, "friction-share", "1") * axis.force_per_ampere * (limit > 0.0 ? limit : effort);
  } else {
    const double carriages = sheet_quantity(answers, "carriages", "1");
    const double on_guides = standard_gravity * sheet_quantity(answers, "load", "kg") +
                             sheet_quantity(answers, "attraction", "N") +
                             carriages * sheet_quantity(answers, "preload", "N");
    f.coulomb = sheet_quantity(answers, "guide-coefficient", "1") * on_guides +
                carriages * sheet_quantity(answers, "seal-drag", "N");
    if (axis.screw > 0.0) f.coulomb += sheet_quantity(answers, "drag-torque", "N m") / axis.screw;
  }
  f.estimated_viscous = answer_to(answers, "viscous").empty();
  // At full speed lubricated guides and bearings drag about twice as much as at low speed.
  f.viscous = f.estimated_viscous ? f.coulomb / sheet_quantity(answers, "max-velocity", turns ? "rad/s" : "m/s")
                                  : sheet_quantity(answers, "viscous", turns ? "N m s/rad" : "N s/m");
  return f;
}

}  // namespace stiction::host
