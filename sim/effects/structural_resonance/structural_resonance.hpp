// An elastic mode between motor and measured position: two masses, the motor's (1 - r) M and the load's r M, on a
// spring k with a damper d. Guideway friction, the forces of the surroundings and the encoder are at the load:
//   (1 - r) M x_m'' = F - f,  r M x'' = f - friction + .., f = k (x_m - x) + d (x_m' - x').
// `frequency` and `damping_ratio` are those of the free mode, w^2 = k / (r (1 - r) M), d = 2 zeta k / w.
// In steps of position, velocity, position (Verlet 1967): the step itself neither damps nor drives, its frequency is
// (w h)^2/24 off.
#pragma once

#include <array>
#include <numbers>

#include "firmware/machine/model/parameter.hpp"
#include "sim/plant/friction/law.hpp"

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

  // `whole`: of both masses.
  StructuralResonance(const Parameters& p, Body whole)
      : step_(whole.step),
        load_mass_(p.mass_ratio * whole.mass),
        step_per_motor_mass_(whole.step / (whole.mass - load_mass_)) {
    const double w = 2.0 * std::numbers::pi * p.frequency;
    stiffness_ = w * w * load_mass_ * (1.0 - p.mass_ratio);
    damping_ = 2.0 * p.damping_ratio * stiffness_ / w;
  }

  double load_mass() const { return load_mass_; }   // kg
  double motor_lead() const { return lead_; }       // m, x_m - x
  double motor_lead_rate() const { return rate_; }  // m/s

  // Force (N) on the load during the step.
  double force() const { return stiffness_ * (lead_ + 0.5 * step_ * rate_) + damping_ * rate_; }
  // Ends the step, with the motor's force (N), force() and the change of the load's velocity (m/s). `motor_force` in N.
  void advance(double motor_force, double force, double change) {
    const double next = rate_ + step_per_motor_mass_ * (motor_force - force) - change;
    lead_ += 0.5 * step_ * (rate_ + next);
    rate_ = next;
  }

 private:
  double step_;
  double load_mass_;
  double step_per_motor_mass_;
  double stiffness_ = 0.0, damping_ = 0.0;
  double lead_ = 0.0, rate_ = 0.0;
};

}  // namespace stiction::sim
