// The slope of viscous friction differs from the file's, whichever friction law acts; the drive
// knows nothing of it.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim {

struct ViscousMismatch {
  struct Parameters {
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "viscous_mismatch";
  static constexpr std::string_view text = "the slope of viscous friction";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "true slope of viscous friction mu_v"},
  }};

  static void change(const Parameters& p, machine::AxisModel& plant) { set_viscous(plant.friction, p.viscous); }
};

}  // namespace stiction::sim
