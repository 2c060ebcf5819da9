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
      : coulomb_(p.coulomb),
        rise_(p.coulomb * (p.static_ratio - 1.0)),
        per_stribeck_velocity_(1.0 / p.stribeck_velocity),
        stribeck_(p.static_ratio > 1.0),
        stiffness_(p.stiffness),
        stiffness_step_(p.stiffness * body.step),
        creep_(p.coulomb / stiffness_step_),
        series_up_to_(stribeck_ ? -1.0 : detail::longest * creep_),
        square_(detail::divisor_c2 / creep_),
        damping_(2.0 * p.damping_ratio * std::sqrt(p.stiffness * body.mass) / stiffness_step_),
        decay_(1.0 / (1.0 + body.step / body.mass * p.viscous)),
        gain_(decay_ * body.step / body.mass) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction. Inline by order, so that the
  // plant's state stays in registers over the steps of a tick.
  [[gnu::always_inline]] double advance(double velocity, double force) {
    return decay_ * velocity + gain_ * (force - move_contact(velocity));
  }

  // Contact deflection limit g(v), m (4.6).
  double deflection_limit(double velocity) const { return level(velocity) / stiffness_; }

  double deflection() const { return spring_ / stiffness_; }  // z, m

  // Lets the contact creep for one step of held velocity (m/s); returns k_s z + b_s z' (N) at its end.
  [[gnu::always_inline]] double move_contact(double velocity) {
    const double speed = std::abs(velocity);
    double most = coulomb_;  // k_s g(v)
    double divisor = 0.0;    // relaxation_divisor(speed / creep) times creep, the speed that creeps g(v) in a step
    if (speed <= series_up_to_) [[likely]] {
      divisor = creep_ + speed * (detail::divisor_c1 + speed * square_);
    } else {
      if (stribeck_) most = level(velocity);
      const double creep = most / stiffness_step_;
      divisor = relaxation_divisor(speed / creep) * creep;
    }
    const double change = (most * velocity - speed * spring_) / divisor;
    spring_ += change;
    return spring_ + damping_ * change;
  }

 private:
  // k_s g(v), N.
  [[gnu::always_inline]] double level(double velocity) const {
    return coulomb_ + rise_ * fall(velocity * per_stribeck_velocity_);
  }
  // A function without effects that is called, as in relaxation_divisor(): where g is constant it costs nothing.
  [[gnu::const, gnu::noinline]] static double fall(double ratio) { return std::exp(-ratio * ratio); }

  double coulomb_;                // F_C
  double rise_;                   // F_Ts - F_C
  double per_stribeck_velocity_;  // 1 / v_s
  bool stribeck_;                 // whether g depends on v
  double stiffness_;              // k_s
  double stiffness_step_;         // k_s times step
  double creep_;                  // m/s that creeps F_C / k_s in a step
  double series_up_to_;           // m/s up to which the series holds; one test for this and Stribeck's
  double square_;                 // s/m, of the speed's square in the divisor
  double damping_;                // b_s / (k_s step)
  double decay_;                  // of the velocity by viscous friction in a step
  double gain_;                   // m/s per N in a step
  double spring_ = 0.0;           // k_s z, N
};

}  // namespace stiction::sim
