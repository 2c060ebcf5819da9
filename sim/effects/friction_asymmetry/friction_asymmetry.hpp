// Friction that differs between directions, by half differences: in +x it is larger by coulomb + viscous |v|, in -x
// smaller by as much. On the carriage both act the same way: F = -coulomb |direction| - viscous |v|, where the
// direction of carriage_state.hpp lets the level arise with the first micrometre of motion and stay at standstill.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class FrictionAsymmetry {
 public:
  struct Parameters {
    double coulomb = 0.0;
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "friction_asymmetry";
  static constexpr std::string_view text = "friction that differs between directions";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"coulomb", "N", machine::any_value(), &Parameters::coulomb, 0.0,
       "half the difference of Coulomb friction, more in +x"},
      {"viscous", "N s/m", machine::any_value(), &Parameters::viscous, 0.0, "half the difference of the viscous slope"},
  }};
  static constexpr bool is_friction = true;

  FrictionAsymmetry(const Parameters& p, Body) : p_(p) {}

  double force(const CarriageState& s) const {
    return -p_.coulomb * std::abs(s.direction) - p_.viscous * std::abs(s.velocity);
  }

 private:
  Parameters p_;
};

}  // namespace stiction::sim
