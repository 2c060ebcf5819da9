// An elastic mode between motor and measured position: two masses, the motor's (1 - r) M and the load's r M, on a
// spring k with a damper d. Guideway friction, the forces of the surroundings and the encoder are at the load:
//   (1 - r) M x_m'' = F - f,  r M x'' = f - friction + .., f = k (x_m - x) + d (x_m' - x').
// `frequency` and `damping_ratio` are those of the free mode, w^2 = k / (r (1 - r) M), d = 2 zeta k / w.
#pragma once

#include <array>
#include <numbers>

#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

class StructuralResonance {
 public:
  struct Parameters {
    double frequency = 0.0;
    double damping_ratio = 0.0;
    double mass_ratio = 0.0;
  };
  static constexpr std::string_view name = "structural_resonance";
  static constexpr std::string_view text = "an elastic mode between motor and measured position";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"frequency", "Hz", machine::positive(2000.0), &Parameters::frequency, {}, "of the mode, both masses free"},
      {"damping_ratio", "1", machine::not_negative(1.0), &Parameters::damping_ratio, {}, "of the mode, 1 = critical"},
      {"mass_ratio",
       "1",
       machine::positive(0.999),
       &Parameters::mass_ratio,
       {},
       "mass on the measured side over the whole"},
  }};

  // `mass` (kg): of both together.
  StructuralResonance(const Parameters& p, double mass) : load_mass(p.mass_ratio * mass), motor_mass(mass - load_mass) {
    const double w = 2.0 * std::numbers::pi * p.frequency;
    stiffness = w * w * load_mass * (1.0 - p.mass_ratio);
    damping = 2.0 * p.damping_ratio * stiffness / w;
  }

  double load_mass, motor_mass;  // kg
  double stiffness;              // N/m
  double damping;                // N s/m
};

}  // namespace stiction::sim
