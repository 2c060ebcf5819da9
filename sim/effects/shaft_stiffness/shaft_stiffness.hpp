// The shaft between motor and load is softer or stiffer than the file's: the plant has `stiffness`, whatever damping
// the file gives it.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

struct ShaftStiffness {
  struct Parameters {
    double stiffness = 0.0;
  };
  static constexpr std::string_view name = "shaft_stiffness";
  static constexpr std::string_view text = "the stiffness between motor and load";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"stiffness", "N/m", machine::positive(), &Parameters::stiffness, {}, "true stiffness, seen at the load"},
  }};

  // Throws EffectError on an axis without a shaft.
  static void check_axis(const Parameters& p, const machine::AxisModel& axis);
  static void change(const Parameters& p, machine::AxisModel& plant);
};

}  // namespace stiction::sim
