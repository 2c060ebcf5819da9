// Friction model C, LuGre (Mendricky 2006, 4.2-4.7; Canudas de Wit, Olsson, Astrom, Lischinsky 1995):
//   z' = v - |v| z / g(v),  k_s g(v) = F_C + (F_Ts - F_C) exp(-(v/v_s)^2),  F = k_s z + b_s z' + mu_v v,
//   b_s = 2 zeta_s sqrt(k_s m) (4.15).
// z takes the exact step of its linear equation for the velocity held over the step, so |z| <= max g is kept for any
// step, stiffness and velocity.
#pragma once

#include <concepts>

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

struct LuGreParameters {
  double coulomb = 0.0;
  double static_ratio = 1.0;
  double viscous = 0.0;
  double stribeck_velocity = 0.0;
  double stiffness = 0.0;
  double damping_ratio = 0.0;
};

template <class Real = double>
class LuGre {
 public:
  using Scalar = Real;
  using Parameters = LuGreParameters;
  static constexpr std::string_view name = "lugre";
  static constexpr std::string_view label = "C LuGre";
  static constexpr std::array<machine::Parameter<Parameters>, 6> parameters{{
      {"coulomb", "N", machine::positive(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"static_ratio", "1", {1.0, 10.0}, &Parameters::static_ratio, 1.0, "static over Coulomb friction, F_Ts / F_C"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
      {"stribeck_velocity", "m/s", machine::positive(), &Parameters::stribeck_velocity, {}, "Stribeck velocity v_s"},
      {"stiffness", "N/m", machine::positive(), &Parameters::stiffness, {}, "contact stiffness k_s"},
      {"damping_ratio", "1", machine::not_negative(), &Parameters::damping_ratio, {}, "contact damping ratio zeta_s"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  // Contact stiffness and the ratio of static friction stay.
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }
  static Parameters rate_independent(Parameters p) {
    p.static_ratio = 1.0;
    p.damping_ratio = p.viscous = 0.0;
    return p;
  }
  static void stretch(Parameters& p, double factor) { p.stiffness /= factor; }

  LuGre(const Parameters& p, Body body)
      : coulomb_(p.coulomb),
        rise_(p.coulomb * (p.static_ratio - 1.0)),
        per_stribeck_velocity_(1.0 / p.stribeck_velocity),
        stiffness_(p.stiffness),
        stiffness_step_(p.stiffness * body.step),
        creep_(p.coulomb / stiffness_step_),
        series_up_to_(p.static_ratio > 1.0 ? -1.0 : detail::longest * creep_),
        square_(detail::divisor_c2 / creep_),
        damping_(2.0 * p.damping_ratio * square_root(p.stiffness * body.mass) / stiffness_step_),
        decay_(1.0 / (1.0 + body.step / body.mass * p.viscous)),
        gain_(decay_ * body.step / body.mass),
        viscous_(p.viscous) {}

  // Inline by order, so that the plant's state stays in registers over the steps of a tick.
  [[gnu::always_inline]] Real advance(Real velocity, Real force) {
    return decay_ * velocity + gain_ * (force - move_contact(velocity));
  }
  Real steady_force(Real velocity, Real direction) const { return level(velocity) * direction + viscous_ * velocity; }
  // From rest the deflection approaches the level exponentially.
  std::optional<Contact> contact() const { return Contact{coulomb_, stiffness_, coulomb_ * ln_10 / stiffness_}; }

  // The share of the rise from Coulomb to static friction that is there at `ratio` Stribeck velocities.
  // A function without effects that is called, as in relaxation_divisor(): where g is constant it costs nothing.
  [[gnu::const, gnu::noinline]] static Real stribeck(Real ratio) { return exponential(-ratio * ratio); }

  // Contact deflection limit g(v), m (4.6).
  Real deflection_limit(Real velocity) const { return level(velocity) / stiffness_; }

  Real deflection() const { return spring_ / stiffness_; }  // z, m

  // Lets the contact creep for one step of held velocity (m/s); returns k_s z + b_s z' (N) at its end.
  [[gnu::always_inline]] Real move_contact(Real velocity) {
    const Real speed = absolute(velocity);
    Real most = coulomb_;  // k_s g(v)
    Real divisor = 0.0;    // relaxation_divisor(speed / creep) times creep, the speed that creeps g(v) in a step
    if constexpr (std::same_as<Real, double>) {
      if (speed <= series_up_to_) [[likely]] {
        divisor = creep_ + speed * (detail::divisor_c1 + speed * square_);
      } else {
        if (series_up_to_ < 0.0) most = level(velocity);
        const Real creep = most / stiffness_step_;
        divisor = relaxation_divisor(speed / creep) * creep;
      }
    } else {  // the same lane by lane
      const auto in_series = speed <= series_up_to_;
      divisor = creep_ + speed * (detail::divisor_c1 + speed * square_);
      if (!all(in_series)) {
        // Where friction does not rise from Coulomb's, the level is that to the bit.
        if (any(series_up_to_ < 0.0)) most = level(velocity);
        const Real creep = most / stiffness_step_;
        divisor = select(in_series, divisor, relaxation_divisor(speed / creep) * creep);
      }
    }
    const Real change = (most * velocity - speed * spring_) / divisor;
    spring_ += change;
    return spring_ + damping_ * change;
  }

 private:
  static constexpr double ln_10 = 2.302585092994046;

  // k_s g(v), N.
  [[gnu::always_inline]] Real level(Real velocity) const {
    return coulomb_ + rise_ * stribeck(velocity * per_stribeck_velocity_);
  }
  Real coulomb_;                // F_C
  Real rise_;                   // F_Ts - F_C
  Real per_stribeck_velocity_;  // 1 / v_s
  Real stiffness_;              // k_s
  Real stiffness_step_;         // k_s times step
  Real creep_;                  // m/s that creeps F_C / k_s in a step
  Real series_up_to_;           // m/s up to which the series holds; below 0 where g depends on v
  Real square_;                 // s/m, of the speed's square in the divisor
  Real damping_;                // b_s / (k_s step)
  Real decay_;                  // of the velocity by viscous friction in a step
  Real gain_;                   // m/s per N in a step
  Real viscous_;                // mu_v
  Real spring_ = 0.0;           // k_s z, N
};

}  // namespace stiction::sim
