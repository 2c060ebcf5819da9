// Friction model C, LuGre (Mendricky 2006, 4.2-4.7; Canudas de Wit, Olsson, Astrom, Lischinsky 1995):
//   z' = v - |v| z / g(v),  k_s g(v) = F_C + (F_Ts - F_C) exp(-(v/v_s)^2),  F = k_s z + b_s z' + mu_v v,
//   b_s = 2 zeta_s sqrt(k_s m) (4.15).
// z takes the exact step of its linear equation for the velocity held over the step, so |z| <= max g is kept for any
// step, stiffness and velocity.
#pragma once

#include <array>
#include <cmath>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

class LuGre {
 public:
  struct Parameters {
    double coulomb = 0.0;
    double static_ratio = 1.0;
    double viscous = 0.0;
    double stribeck_velocity = 0.0;
    double stiffness = 0.0;
    double damping_ratio = 0.0;
  };
  static constexpr std::string_view name = "lugre";
  static constexpr std::string_view label = "C LuGre";
  static constexpr std::array<Parameter<Parameters>, 6> parameters{{
      {"coulomb", "N", positive(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"static_ratio", "1", {1.0, 10.0}, &Parameters::static_ratio, 1.0, "static over Coulomb friction, F_Ts / F_C"},
      {"viscous", "N s/m", not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
      {"stribeck_velocity", "m/s", positive(), &Parameters::stribeck_velocity, {}, "Stribeck velocity v_s"},
      {"stiffness", "N/m", positive(), &Parameters::stiffness, {}, "contact stiffness k_s"},
      {"damping_ratio", "1", not_negative(), &Parameters::damping_ratio, {}, "contact damping ratio zeta_s"},
  }};

  LuGre(const Parameters& p, Body body)
      : p_(p),
        step_(body.step),
        gain_(body.step / body.mass),
        implicit_(1.0 / (1.0 + gain_ * p.viscous)),
        sliding_limit_(p.coulomb / p.stiffness),
        step_per_limit_(body.step / sliding_limit_),
        damping_per_step_(2.0 * p.damping_ratio * std::sqrt(p.stiffness * body.mass) / body.step) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double contact = move_contact(velocity);
    return (velocity + gain_ * (force - contact)) * implicit_;
  }

  // Contact deflection limit g(v), m (4.6).
  double deflection_limit(double velocity) const {
    if (p_.static_ratio == 1.0) return sliding_limit_;
    const double ratio = velocity / p_.stribeck_velocity;
    return sliding_limit_ * (1.0 + (p_.static_ratio - 1.0) * std::exp(-ratio * ratio));
  }

  double deflection() const { return z_; }  // z, m

  // Lets the contact creep for one step of held velocity (m/s); returns k_s z + b_s z' (N) at its end.
  double move_contact(double velocity) {
    const double g = deflection_limit(velocity);
    const double share = one_minus_exp(std::abs(velocity) * (p_.static_ratio == 1.0 ? step_per_limit_ : step_ / g));
    const double change = share * (std::copysign(g, velocity) - z_);
    z_ += change;
    return p_.stiffness * z_ + damping_per_step_ * change;
  }

 private:
  Parameters p_;
  double step_;
  double gain_;
  double implicit_;
  double sliding_limit_;  // g far from standstill, m
  double step_per_limit_;
  double damping_per_step_;  // b_s / step
  double z_ = 0.0;
};

}  // namespace stiction::sim
