// Friction model D, Coulomb and viscous: F = F_C sgn(v) + mu_v v, zero at v = 0 (Mendricky 2006, 4.1). It cannot stick
// and chatters around standstill; it stays as the baseline of what a toolbox block gives.
#pragma once

#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

struct CoulombViscousParameters {
  double coulomb = 0.0;
  double viscous = 0.0;
};

template <class Real = double>
class CoulombViscous {
 public:
  using Scalar = Real;
  using Parameters = CoulombViscousParameters;
  static constexpr std::string_view name = "coulomb_viscous";
  static constexpr std::string_view label = "D Coulomb and viscous";
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"coulomb", "N", machine::not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }

  CoulombViscous(const Parameters& p, Body body)
      : coulomb_(p.coulomb), viscous_(p.viscous), gain_(body.step / body.mass) {}

  Real advance(Real velocity, Real force) {
    const Real sign = select(velocity > 0.0, Real(1.0), select(velocity < 0.0, Real(-1.0), Real(0.0)));
    return (velocity + gain_ * (force - coulomb_ * sign)) / (1.0 + gain_ * viscous_);
  }
  Real steady_force(Real velocity, Real direction) const { return coulomb_ * direction + viscous_ * velocity; }
  std::optional<Contact> contact() const { return {}; }

 private:
  Real coulomb_, viscous_, gain_;
};

}  // namespace stiction::sim
