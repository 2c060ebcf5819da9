// The elasto-plastic model (Dupont, Hayward, Armstrong, Altpeter 2002, IEEE Trans. Automatic Control 47, 787-792):
// LuGre whose contact is purely elastic up to the break-away deflection z_ba, so that a load below it makes no drift:
//   z' = v (1 - a(z, v) sgn(v) z / g(v)),  F = k_s z + b_s z' + mu_v v,  b_s = 2 zeta_s sqrt(k_s m),
//   k_s g(v) = F_C + (F_Ts - F_C) exp(-(v/v_s)^2),
//   a = 0 below z_ba and wherever z and v have opposite signs, 1 from g on, and between them half a sine,
//   a = (1 + sin(pi (|z| - (g + z_ba)/2) / (g - z_ba))) / 2.
// A step takes a from its beginning and solves the linear equation that this leaves exactly.
#pragma once

#include "sim/number/arithmetic.hpp"
#include "sim/number/sine_cosine.hpp"
#include "sim/plant/friction/law.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

struct ElastoPlasticParameters {
  double coulomb = 0.0;
  double static_ratio = 1.0;
  double viscous = 0.0;
  double stribeck_velocity = 1e-3;
  double stiffness = 0.0;
  double damping_ratio = 0.0;
  double break_away_share = 0.7;
};

template <class Real = double>
class ElastoPlastic {
 public:
  using Scalar = Real;
  using Parameters = ElastoPlasticParameters;
  static constexpr std::string_view name = "elasto_plastic";
  static constexpr std::string_view label = "Elasto-plastic";
  static constexpr std::array<machine::Parameter<Parameters>, 7> parameters{{
      {"coulomb", "N", machine::positive(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"static_ratio", "1", {1.0, 10.0}, &Parameters::static_ratio, 1.0, "static over Coulomb friction, F_Ts / F_C"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, 0.0, "viscous friction mu_v"},
      {"stribeck_velocity", "m/s", machine::positive(), &Parameters::stribeck_velocity, 1e-3, "Stribeck velocity v_s"},
      {"stiffness", "N/m", machine::positive(), &Parameters::stiffness, {}, "contact stiffness k_s"},
      {"damping_ratio", "1", machine::not_negative(), &Parameters::damping_ratio, 0.0, "contact damping ratio zeta_s"},
      {"break_away_share",
       "1",
       {0.0, 0.99},
       &Parameters::break_away_share,
       0.7,
       "force up to which the contact is elastic, as a share of Coulomb friction: k_s z_ba / F_C"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }
  static Parameters rate_independent(Parameters p) {
    p.static_ratio = 1.0;
    p.damping_ratio = p.viscous = 0.0;
    return p;
  }
  static void stretch(Parameters& p, double factor) { p.stiffness /= factor; }

  ElastoPlastic(const Parameters& p, Body body)
      : coulomb_(p.coulomb),
        rise_(p.coulomb * (p.static_ratio - 1.0)),
        stribeck_velocity_(p.stribeck_velocity),
        stiffness_(p.stiffness),
        elastic_(p.break_away_share * p.coulomb),
        damping_(2.0 * p.damping_ratio * square_root(p.stiffness * body.mass) / (p.stiffness * body.step)),
        viscous_(p.viscous),
        step_(body.step),
        gain_(body.step / body.mass) {}

  Real advance(Real velocity, Real force) {
    const Real contact = move_contact(velocity);
    return (velocity + gain_ * (force - contact)) / (1.0 + gain_ * viscous_);
  }
  Real steady_force(Real velocity, Real direction) const { return level(velocity) * direction + viscous_ * velocity; }
  // In slow sliding along the displacement s the spring obeys d(spring)/ds = k_s (1 - a spring / F_C).
  std::optional<Contact> contact() const {
    constexpr int parts = 4096;  // of Coulomb friction; at each the slope is that of the law
    Real distance = 0.0;
    for (int i = 0; i < parts * 9 / 10; ++i) {
      const Real spring = coulomb_ * (i + 0.5) / parts;
      distance += coulomb_ / parts / (stiffness_ * (1.0 - plastic(spring, coulomb_) * spring / coulomb_));
    }
    return Contact{coulomb_, stiffness_, distance};
  }

  // Moves the contact for one step of held velocity (m/s); returns k_s z + b_s z' (N) at its end.
  Real move_contact(Real velocity) {
    const Real speed = absolute(velocity), travelled = stiffness_ * step_ * velocity;
    const Real most = level(velocity);
    const auto loads = spring_ * velocity > 0.0;
    Real share = 0.0;
    if (any(loads)) share = select(loads, plastic(absolute(spring_), most), share);
    const Real rate = share * stiffness_ * step_ * speed / most;
    const Real change = (travelled - rate * spring_) / relaxation_divisor(rate);
    // A long step must not leap from the elastic part over the level.
    const Real bound = select(absolute(spring_) > most, Real(absolute(spring_)), most), next = spring_ + change;
    spring_ = select(absolute(next) > bound, Real(copy_sign(bound, next)), next);
    return spring_ + damping_ * change;
  }

 private:
  // k_s g(v), N.
  Real level(Real velocity) const {
    const Real ratio = velocity / stribeck_velocity_;
    if (all(rise_ == 0.0)) return coulomb_;
    return coulomb_ + rise_ * exponential(-ratio * ratio);
  }
  // a at a spring force (N, against the level `most`) that the motion loads further.
  Real plastic(Real spring, Real most) const {
    const auto elastic = spring <= elastic_, full = spring >= most;
    if (all(elastic)) return 0.0;
    if (all(full)) return 1.0;
    constexpr double pi = 3.141592653589793;
    const Real between = 0.5 + 0.5 * sine_cosine(pi * (spring - 0.5 * (most + elastic_)) / (most - elastic_)).sine;
    return select(elastic, Real(0.0), select(full, Real(1.0), between));
  }

  Real coulomb_, rise_, stribeck_velocity_, stiffness_;
  Real elastic_;  // k_s z_ba, N
  Real damping_;  // b_s / (k_s step)
  Real viscous_, step_, gain_;
  Real spring_ = 0.0;  // k_s z, N
};

}  // namespace stiction::sim
