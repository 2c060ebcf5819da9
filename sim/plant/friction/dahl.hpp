// Dahl's model (Dahl 1968, 1976): a contact that approaches the Coulomb level along the displacement s,
//   dF/ds = k_s (1 - F sgn(ds) / F_C)^n,
// plus viscous friction. It remembers its last reversal only, and has no static friction above Coulomb's. The share
// that is missing to the level, u = 1 - F sgn(ds) / F_C from 0 to 2, obeys du/d|s| = -(k_s / F_C) u^n, which is solved
// exactly for the displacement of a step.
#pragma once

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"
#include "sim/plant/friction/one_minus_exp.hpp"

namespace stiction::sim {

struct DahlParameters {
  double coulomb = 0.0;
  double stiffness = 0.0;
  double exponent = 1.0;
  double viscous = 0.0;
};

template <class Real = double>
class Dahl {
 public:
  using Scalar = Real;
  using Parameters = DahlParameters;
  static constexpr std::string_view name = "dahl";
  static constexpr std::string_view label = "Dahl";
  static constexpr std::array<machine::Parameter<Parameters>, 4> parameters{{
      {"coulomb", "N", machine::positive(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"stiffness", "N/m", machine::positive(), &Parameters::stiffness, {}, "contact stiffness k_s at rest"},
      {"exponent",
       "1",
       {0.0, 10.0},
       &Parameters::exponent,
       1.0,
       "exponent n: 0 is elastic and ideally plastic, 1 exponential, above 1 a long tail"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, 0.0, "viscous friction mu_v"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }
  static Parameters rate_independent(Parameters p) {
    p.viscous = 0.0;
    return p;
  }
  static void stretch(Parameters& p, double factor) { p.stiffness /= factor; }

  Dahl(const Parameters& p, Body body)
      : coulomb_(p.coulomb),
        stiffness_(p.stiffness),
        exponent_(p.exponent),
        viscous_(p.viscous),
        step_(body.step),
        gain_(body.step / body.mass) {}

  Real advance(Real velocity, Real force) {
    const Real contact = move_contact(velocity);
    return (velocity + gain_ * (force - contact)) / (1.0 + gain_ * viscous_);
  }
  Real steady_force(Real velocity, Real direction) const { return coulomb_ * direction + viscous_ * velocity; }
  std::optional<Contact> contact() const {
    // The integral of u^-n from 0.1 to 1.
    const Real n = exponent_, ln_10 = -logarithm(0.1);
    const Real lengths = n == 1.0 ? ln_10 : (exponential((n - 1.0) * ln_10) - 1.0) / (n - 1.0);
    return Contact{coulomb_, stiffness_, lengths * coulomb_ / stiffness_};
  }

  // Moves the contact for one step of held velocity (m/s); returns its force (N) at the end.
  Real move_contact(Real velocity) {
    const Real way = absolute(velocity) * step_ * stiffness_ / coulomb_;  // in lengths F_C / k_s
    if (way == 0.0) return force_;
    const Real sign = copy_sign(Real(1.0), velocity);
    force_ = sign * coulomb_ * (1.0 - after(1.0 - sign * force_ / coulomb_, way));
    return force_;
  }

 private:
  // The missing share u after `way` lengths.
  Real after(Real u, Real way) const {
    if (u <= 0.0) return 0.0;
    const Real n = exponent_;
    if (n == 1.0) return u - u * one_minus_exp(way);
    const Real grown = power(u, absolute(1.0 - n));  // u^(1 - n), or its inverse above n = 1
    if (n > 1.0) return power(grown / (1.0 + (n - 1.0) * way * grown), 1.0 / (n - 1.0));
    const Real rest = grown - (1.0 - n) * way;
    return rest <= 0.0 ? Real(0.0) : power(rest, 1.0 / (1.0 - n));
  }

  Real coulomb_, stiffness_, exponent_, viscous_, step_, gain_;
  Real force_ = 0.0;  // N, of the contact
};

}  // namespace stiction::sim
