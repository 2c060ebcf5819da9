// An elastic mode: the mass M in two parts on a spring k with a damper d. Guideway friction, the forces of the
// surroundings and the encoder are at the measured part, r M, at x. The motor drives the other one, at y,
//   (1 - r) M y'' = F - f,  r M x'' = f - friction + .., f = k (y - x) + d (y' - x'),
// or the measured one, and the other one hangs behind it:
//   (1 - r) M y'' = -f,  r M x'' = F + f - friction + ...
// `frequency` and `damping_ratio` are those of the free mode, w^2 = k / (r (1 - r) M), d = 2 zeta k / w.
#pragma once

#include <array>
#include <numbers>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

class StructuralResonance {
 public:
  struct Parameters {
    double frequency = 0.0;
    double damping_ratio = 0.0;
    double mass_ratio = 0.0;
    int motor_measured = 0;
  };
  static constexpr std::string_view name = "structural_resonance";
  static constexpr std::string_view text =
      "an elastic mode between motor and measured position, or of a body behind both";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 4> parameters{{
      {"frequency", "Hz", machine::positive(2000.0), &Parameters::frequency, {}, "of the mode, both masses free"},
      {"damping_ratio", "1", machine::not_negative(1.0), &Parameters::damping_ratio, {}, "of the mode, 1 = critical"},
      {"mass_ratio",
       "1",
       machine::positive(0.999),
       &Parameters::mass_ratio,
       {},
       "mass on the measured side over the whole"},
      {"motor_measured",
       "1",
       {0.0, 1.0},
       &Parameters::motor_measured,
       0.0,
       "1: the motor drives the measured side, and the other one hangs behind it; 0: it drives the other one"},
  }};

  // Throws EffectError for a mode between motor and load of an axis that has a shaft there.
  static void check_axis(const Parameters& p, const machine::AxisModel& axis);

  // `mass` (kg): of both together.
  StructuralResonance(const Parameters& p, double mass)
      : measured_mass(p.mass_ratio * mass), other_mass(mass - measured_mass), motor_measured(p.motor_measured != 0) {
    const double w = 2.0 * std::numbers::pi * p.frequency;
    stiffness = w * w * measured_mass * (1.0 - p.mass_ratio);
    damping = 2.0 * p.damping_ratio * stiffness / w;
  }

  double measured_mass, other_mass;  // kg
  bool motor_measured;
  double stiffness;  // N/m
  double damping;    // N s/m
};

}  // namespace stiction::sim
