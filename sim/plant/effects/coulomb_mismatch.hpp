// The level of Coulomb friction differs from the file's, whichever friction model acts (friction_level.hpp); the drive
// knows nothing of it.
#pragma once

#include <array>

#include "sim/model/machine.hpp"
#include "sim/parameter.hpp"
#include "sim/plant/effects/friction_level.hpp"

namespace stiction::sim {

struct CoulombMismatch {
  struct Parameters {
    double coulomb = 0.0;
  };
  static constexpr std::string_view name = "coulomb_mismatch";
  static constexpr std::string_view text = "the level of Coulomb friction";
  static constexpr bool several = false;
  static constexpr std::array<Parameter<Parameters>, 1> parameters{{
      {"coulomb", "N", positive(), &Parameters::coulomb, {}, "true level of Coulomb friction F_C"},
  }};

  static void change(const Parameters& p, Axis& plant) { set_coulomb(plant.friction, p.coulomb); }
};

}  // namespace stiction::sim
