// For the tests of effects: a carriage that a stiff servo moves at a given speed, so that what an effect adds can be
// read as force.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/effects/effects.hpp"
#include "sim/plant/axis_plant.hpp"
#include "sim/plant/friction/classical.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/friction.hpp"
#include "sim/plant/friction/linear_ramp.hpp"
#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::sim::test {

inline constexpr machine::Timing timing{62.5e-6, 1e-3};
inline constexpr double tick = 62.5e-6;

// A force source of 10 N/V on 50 kg, without dead time and encoder errors; 20 N Coulomb and 100 N s/m viscous friction.
inline machine::AxisModel force_axis() {
  machine::AxisModel axis;
  axis.name = "x";
  axis.mass = 50.0;
  axis.travel = 1.0;
  axis.motor.model = machine::MotorModel::force;
  axis.motor.force_constant = 10.0;
  axis.inverter = {0.0, 1000.0, 1.0};
  axis.friction.use = "classical";
  set_parameters<CoulombViscous<>>(axis.friction, {20.0, 100.0});
  set_parameters<Classical<>>(axis.friction, {20.0, 1.0, 100.0});
  set_parameters<LinearRamp<>>(axis.friction, {20.0, 12000.0, 100.0});
  set_parameters<Parabolic<>>(axis.friction, {300.0, 3.0});
  set_parameters<LuGre<>>(axis.friction, {20.0, 1.0, 100.0, 1e-3, 1e6, 0.1});
  set_parameters<MaxwellSlip<>>(axis.friction, {{1e6, 1e6}, {5.0, 15.0}, 100.0});
  return axis;
}

inline machine::AxisModel with_effects(std::vector<machine::Effect> effects, machine::AxisModel axis = force_axis()) {
  axis.effects = std::move(effects);
  return axis;
}

// Mean force (N) that keeps the carriage at `speed` (m/s) from `start` (m) over `ticks`, after as many to settle. The
// servo's slow integral makes the mean of its force that of the resistance, whatever is periodic.
inline double force_at(const machine::AxisModel& axis, double speed, double start = 0.0, int ticks = 4000) {
  AxisPlant plant(timing, axis, start, 1);
  double set = start, integral = 0.0, sum = 0.0;
  for (int k = 0; k < 2 * ticks; ++k) {
    set += speed * tick;
    const double error = set - plant.position();
    integral += 200.0 * error * tick;
    const double force = 5e6 * (error + integral) + 2e4 * (speed - plant.velocity());
    plant.command({force / axis.motor.force_constant, 0.0, 0.0}, true);
    plant.advance_tick();
    if (k >= ticks) sum += plant.motor_force();
  }
  return sum / ticks;
}

// Force (N) that the effects of `axis` put on the carriage, positive in +x: what they take off the motor.
inline double effect_force(const machine::AxisModel& axis, double speed, double start = 0.0, int ticks = 4000) {
  return force_at(with_effects({}, axis), speed, start, ticks) - force_at(axis, speed, start, ticks);
}

}  // namespace stiction::sim::test
