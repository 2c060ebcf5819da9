// Friction model B2, parabolic (Mendricky 2006, 4.3): F = a |v|^(1/n) sgn(v). Its slope at standstill is infinite, so
// an explicit step chatters; the step is solved implicitly for s = |v|^(1/n): s^n + (h a / m) s = |v + h F / m|.
// A Coulomb level and a viscous slope may be in addition to the root, which the source's model does not have:
//   (1 + h mu_v / m) s^n + (h a / m) s = |v + h F / m| - h F_C / m, and s = 0 where the right side is not positive.
#pragma once

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

struct ParabolicParameters {
  double force_at_1_m_per_s = 0.0;
  double order = 1.0;
  double coulomb = 0.0;
  double viscous = 0.0;
};

template <class Real = double>
class Parabolic {
 public:
  using Scalar = Real;
  using Parameters = ParabolicParameters;
  static constexpr std::string_view name = "parabolic";
  static constexpr std::string_view label = "B2 parabolic";
  static constexpr std::array<machine::Parameter<Parameters>, 4> parameters{{
      {"force_at_1_m_per_s", "N", machine::not_negative(), &Parameters::force_at_1_m_per_s, {}, "friction a at 1 m/s"},
      {"order", "1", {1.0, 20.0}, &Parameters::order, {}, "order n of the root"},
      {"coulomb", "N", machine::not_negative(), &Parameters::coulomb, 0.0,
       "Coulomb friction F_C in addition to the root"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, 0.0,
       "viscous friction mu_v in addition to the root"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }

  Parabolic(const Parameters& p, Body body)
      : force_(p.force_at_1_m_per_s),
        order_(p.order),
        coulomb_(p.coulomb),
        viscous_(p.viscous),
        gain_(body.step / body.mass),
        slope_(gain_ * force_),
        inertia_(1.0 + gain_ * viscous_) {}

  Real advance(Real velocity, Real force) {
    const Real free = velocity + gain_ * force;
    const Real target = absolute(free) - gain_ * coulomb_;
    if (target <= 0.0) return 0.0;
    if (slope_ == 0.0) return copy_sign(target / inertia_, free);
    // Both terms alone bound the root from above; from there Newton's steps on a convex function fall to it.
    const Real by_slope = target / slope_;
    Real s = power(by_slope, order_) < target ? by_slope : power(target, 1.0 / order_);
    for (int i = 0; i < 60; ++i) {
      const Real below = power(s, order_ - 1.0);
      const Real next = s - (inertia_ * below * s + slope_ * s - target) / (order_ * inertia_ * below + slope_);
      if (!(next < s) || s - next < 1e-13 * s) break;
      s = next;
    }
    return copy_sign(power(s, order_), free);
  }
  Real steady_force(Real velocity, Real direction) const {
    return copy_sign(force_ * power(absolute(velocity), 1.0 / order_), velocity) + coulomb_ * direction +
           viscous_ * velocity;
  }
  std::optional<Contact> contact() const { return {}; }

 private:
  Real force_, order_, coulomb_, viscous_, gain_, slope_, inertia_;
};

}  // namespace stiction::sim
