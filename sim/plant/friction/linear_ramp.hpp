// Friction model B1, linear ramp (Mendricky 2006, 4.3): F = mu_0 v up to the break velocity v_0 = F_C / mu_0, beyond
// it F = (F_C + (|v| - v_0) mu_v) sgn(v). Solved implicitly, exactly on each of its two lines.
#pragma once

#include "sim/number/arithmetic.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

struct LinearRampParameters {
  double coulomb = 0.0;
  double slope = 0.0;
  double viscous = 0.0;
};

template <class Real = double>
class LinearRamp {
 public:
  using Scalar = Real;
  using Parameters = LinearRampParameters;
  static constexpr std::string_view name = "linear_ramp";
  static constexpr std::string_view label = "B1 linear ramp";
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"coulomb", "N", machine::not_negative(), &Parameters::coulomb, {}, "Coulomb friction F_C"},
      {"slope", "N s/m", machine::positive(), &Parameters::slope, {}, "slope mu_0 below the break velocity"},
      {"viscous", "N s/m", machine::not_negative(), &Parameters::viscous, {}, "slope mu_v above the break velocity"},
  }};
  static double coulomb(const Parameters& p) { return p.coulomb; }
  static double viscous(const Parameters& p) { return p.viscous; }
  // The slope below the break velocity stays, so this moves the break velocity.
  static void set_coulomb(Parameters& p, double coulomb) { p.coulomb = coulomb; }
  static void set_viscous(Parameters& p, double viscous) { p.viscous = viscous; }

  LinearRamp(const Parameters& p, Body body)
      : coulomb_(p.coulomb),
        slope_(p.slope),
        viscous_(p.viscous),
        gain_(body.step / body.mass),
        break_velocity_(p.coulomb / p.slope) {}

  Real advance(Real velocity, Real force) {
    const Real free = velocity + gain_ * force;
    const Real slow = free / (1.0 + gain_ * slope_);
    const auto on_ramp = absolute(slow) <= break_velocity_;
    if (all(on_ramp)) return slow;
    const Real offset = (coulomb_ - break_velocity_ * viscous_) * copy_sign(Real(1.0), free);
    return select(on_ramp, slow, Real((free - gain_ * offset) / (1.0 + gain_ * viscous_)));
  }
  // The direction matters nowhere: at standstill the force is zero.
  Real steady_force(Real velocity, Real) const {
    const Real beyond = absolute(velocity) - break_velocity_;
    return beyond <= 0.0 ? slope_ * velocity : copy_sign(coulomb_ + viscous_ * beyond, velocity);
  }
  std::optional<Contact> contact() const { return {}; }

 private:
  Real coulomb_, slope_, viscous_, gain_, break_velocity_;
};

}  // namespace stiction::sim
