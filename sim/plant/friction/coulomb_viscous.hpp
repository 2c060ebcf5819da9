// Friction model D, Coulomb and viscous: F = F_C sgn(v) + mu_v v, zero at v = 0 (Mendricky 2006, 4.1). It cannot stick
// and chatters around standstill; it stays as the baseline of what a toolbox block gives.
#pragma once

#include <array>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"

namespace stiction::sim {

class CoulombViscous {
 public:
  struct Parameters {
    double coulomb = 0.0;
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "coulomb_viscous";
  static constexpr std::string_view label = "D Coulomb and viscous";
  static constexpr std::array<Parameter<Parameters>, 2> parameters{{
      {"coulomb", "N", not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
  }};

  CoulombViscous(const Parameters& p, Body body) : p_(p), gain_(body.step / body.mass) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double sign = velocity > 0.0 ? 1.0 : velocity < 0.0 ? -1.0 : 0.0;
    return (velocity + gain_ * (force - p_.coulomb * sign)) / (1.0 + gain_ * p_.viscous);
  }

 private:
  Parameters p_;
  double gain_;
};

}  // namespace stiction::sim
