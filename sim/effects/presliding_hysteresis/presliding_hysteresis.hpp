// Spring-like, rate-independent displacement before sliding: the friction model in use is replaced by Maxwell-slip
// elements with its Coulomb and viscous values. Their curve of first loading is Dahl's (1968) with the exponent n that
// reaches 90 % of Coulomb after `distance`,
//   dF/ds = stiffness (1 - F/F_C)^n,  F(distance) = 0.9 F_C,
// which holds between an elastic-plastic line (stiffness times distance = 0.9 F_C, n = 0) and a long tail.
#pragma once

#include <array>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::sim {

struct PreslidingHysteresis {
  struct Parameters {
    double stiffness = 0.0;
    double distance = 0.0;
  };
  static constexpr std::string_view name = "presliding_hysteresis";
  static constexpr std::string_view text = "spring-like, rate-independent displacement before sliding";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"stiffness",
       "N/m",
       machine::positive(),
       &Parameters::stiffness,
       {},
       "stiffness at the beginning of a displacement"},
      {"distance", "m", machine::positive(), &Parameters::distance, {}, "displacement to 90 % of Coulomb friction"},
  }};
  // stiffness * distance, in units of Coulomb friction.
  static constexpr machine::Range sharpness{0.9, 1000.0};

  // Throws EffectError where Coulomb friction does not fit (see sharpness).
  static void change(const Parameters& p, machine::AxisModel& plant);
};

// The elements of that curve: its polygon of tangents at 0, 10, .. 90 and 98 % of Coulomb friction, so that initial
// stiffness, the point at 90 % and Coulomb friction are exact. Throws EffectError beyond `sharpness`. `coulomb` in N,
// `distance` in m.
MaxwellSlipParameters presliding_elements(double coulomb, double stiffness, double distance);

}  // namespace stiction::sim
