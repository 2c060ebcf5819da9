// The motor's force constant differs from the file's: F = K_F i with the true K_F. The windings' back EMF is of the
// same magnets and changes in proportion; the drive's current feedforward keeps the file's value. A current scale that
// is off by a factor shows in the same way.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct ForceConstantMismatch {
  struct Parameters {
    double force_constant = 0.0;
  };
  static constexpr std::string_view name = "force_constant_mismatch";
  static constexpr std::string_view text = "the motor's force constant, or the scale of the current";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"force_constant",
       "N/A",
       machine::positive(),
       &Parameters::force_constant,
       {},
       "true force constant, amplitude amperes",
       "N/V"},
  }};

  static void change(const Parameters& p, machine::AxisModel& plant) {
    auto& motor = plant.motor;
    // Of three windings the whole motor has 3/2 of one (Mendricky 2006, 3.14); the file may round its own value.
    const double before =
        motor.model == machine::MotorModel::synchronous ? 1.5 * motor.phase_force_constant : motor.force_constant;
    motor.phase_force_constant = p.force_constant / 1.5;
    motor.force_constant = p.force_constant;
    motor.emf_constant *= p.force_constant / before;
  }
};

}  // namespace stiction::sim
