// Friction model A, classical (Mendricky 2006, 4.2): at standstill the friction balances the applied force up to the
// static level; in motion F = (F_C + mu_v |v|) sgn(v). Sticking is exact: a zero crossing inside a step is caught, so
// the velocity is zero to the bit while the carriage sticks.
#pragma once

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

struct ClassicalParameters {
  double coulomb = 0.0;
  double static_ratio = 1.0;
  double viscous = 0.0;
};

template <class Real = double>
class Classical {
 public:
  using Scalar = Real;
  using Parameters = ClassicalParameters;
  static constexpr std::string_view name = "classical";
  static constexpr std::string_view label = "A classical";
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"coulomb", "N", machine::not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"static_ratio", "1", {1.0, 10.0}, &Parameters::static_ratio, 1.0, "static over Coulomb friction, F_Ts / F_C"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "viscous friction mu_v"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }

  Classical(const Parameters& p, Body body)
      : coulomb_(p.coulomb),
        static_level_(p.coulomb * p.static_ratio),
        viscous_(p.viscous),
        mass_(body.mass),
        step_(body.step) {}

  Real advance(Real velocity, Real force) {
    const auto rests = velocity == 0.0;
    if (all(rests)) return start(force, step_);
    const Real direction = copy_sign(Real(1.0), velocity);
    const Real next = slide(velocity, force, direction, step_);
    const auto goes_on = next * direction > 0.0 && !rests;
    if (all(goes_on)) return next;
    const Real until_stop = step_ * velocity / (velocity - next);
    return select(goes_on, next, start(force, select(rests, step_, Real(step_ - until_stop))));
  }
  Real steady_force(Real velocity, Real direction) const { return coulomb_ * direction + viscous_ * velocity; }
  std::optional<Contact> contact() const { return {}; }

 private:
  Real start(Real force, Real duration) const {
    const auto sticks = absolute(force) <= static_level_;
    if (all(sticks)) return 0.0;
    return select(sticks, Real(0.0), slide(0.0, force, copy_sign(Real(1.0), force), duration));
  }
  Real slide(Real velocity, Real force, Real direction, Real duration) const {
    const Real gain = duration / mass_;
    return (velocity + gain * (force - coulomb_ * direction)) / (1.0 + gain * viscous_);
  }

  Real coulomb_, static_level_, viscous_, mass_, step_;
};

}  // namespace stiction::sim
