// Gains and integral times of the machine's drive differ from the file's: the simulated drive has the true ones, where
// they are given. The one effect that is not in the plant: see drive_axis() of effects.hpp.
#pragma once

#include <array>
#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

struct ControllerGainMismatch {
  struct Parameters {
    std::optional<double> position_gain, velocity_gain, velocity_integral_time, current_gain, current_integral_time;
  };
  static constexpr std::string_view name = "controller_gain_mismatch";
  static constexpr std::string_view text = "a loop gain or integral time of the drive";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 5> parameters{{
      {"position_gain",
       "1/s",
       machine::positive(),
       &Parameters::position_gain,
       {},
       "true gain of the position controller"},
      {"velocity_gain",
       "A s/m",
       machine::positive(),
       &Parameters::velocity_gain,
       {},
       "true gain of the velocity controller",
       "V s/m"},
      {"velocity_integral_time",
       "s",
       machine::positive(),
       &Parameters::velocity_integral_time,
       {},
       "true integral time of the velocity controller"},
      {"current_gain",
       "V/A",
       machine::positive(),
       &Parameters::current_gain,
       {},
       "true gain of the current controller"},
      {"current_integral_time",
       "s",
       machine::positive(),
       &Parameters::current_integral_time,
       {},
       "true integral time of the current controller"},
  }};

  // Throws EffectError.
  static void check(const Parameters& p) {
    if (!p.position_gain && !p.velocity_gain && !p.velocity_integral_time && !p.current_gain &&
        !p.current_integral_time)
      throw EffectError(name, "none of its keys", "those that differ");
  }

  // Throws EffectError where there is no such controller.
  static void change_drive(const Parameters& p, machine::AxisModel& drive) {
    if (p.position_gain) drive.position_controller.gain = *p.position_gain;
    if (p.velocity_gain) drive.velocity_controller.gain = *p.velocity_gain;
    if (p.velocity_integral_time) drive.velocity_controller.integral_time = p.velocity_integral_time;
    if ((p.current_gain || p.current_integral_time) && !drive.current_controller)
      throw EffectError(name, "a current controller's parameter", "none, the axis has no current controller");
    if (p.current_gain) drive.current_controller->gain = *p.current_gain;
    if (p.current_integral_time) drive.current_controller->integral_time = p.current_integral_time;
  }
};

}  // namespace stiction::sim
