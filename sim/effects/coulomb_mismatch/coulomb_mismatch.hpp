// The level of Coulomb friction differs from the file's, whichever friction law acts; the drive
// knows nothing of it.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim {

struct CoulombMismatch {
  struct Parameters {
    double coulomb = 0.0;
  };
  static constexpr std::string_view name = "coulomb_mismatch";
  static constexpr std::string_view text = "the level of Coulomb friction";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"coulomb", "N", machine::positive(), &Parameters::coulomb, {}, "true level of Coulomb friction F_C"},
  }};

  static void change(const Parameters& p, machine::AxisModel& plant) { set_coulomb(plant.friction, p.coulomb); }
};

}  // namespace stiction::sim
