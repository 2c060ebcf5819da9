// Friction model B1, linear ramp (Mendricky 2006, 4.3): F = mu_0 v up to the break velocity v_0 = F_C / mu_0, beyond
// it F = (F_C + (|v| - v_0) mu_v) sgn(v). Solved implicitly, exactly on each of its two lines.
#pragma once

#include <array>
#include <cmath>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"

namespace stiction::sim {

class LinearRamp {
 public:
  struct Parameters {
    double coulomb = 0.0;
    double slope = 0.0;
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "linear_ramp";
  static constexpr std::string_view label = "B1 linear ramp";
  static constexpr std::array<Parameter<Parameters>, 3> parameters{{
      {"coulomb", "N", not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"slope", "N s/m", positive(), &Parameters::slope, {}, "slope mu_0 below the break velocity"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "slope mu_v above the break velocity"},
  }};

  LinearRamp(const Parameters& p, Body body)
      : p_(p), gain_(body.step / body.mass), break_velocity_(p.coulomb / p.slope) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double free = velocity + gain_ * force;
    const double slow = free / (1.0 + gain_ * p_.slope);
    if (std::abs(slow) <= break_velocity_) return slow;
    const double offset = (p_.coulomb - break_velocity_ * p_.viscous) * std::copysign(1.0, free);
    return (free - gain_ * offset) / (1.0 + gain_ * p_.viscous);
  }

 private:
  Parameters p_;
  double gain_;
  double break_velocity_;
};

}  // namespace stiction::sim
