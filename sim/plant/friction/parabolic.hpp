// Friction model B2, parabolic (Mendricky 2006, 4.3): F = a |v|^(1/n) sgn(v). Its slope at standstill is infinite, so
// an explicit step chatters; the step is solved implicitly for s = |v|^(1/n): s^n + (h a / m) s = |v + h F / m|.
// Effects may put a Coulomb level and a viscous slope beside the root, which the model of a file does not have:
//   (1 + h mu_v / m) s^n + (h a / m) s = |v + h F / m| - h F_C / m, and s = 0 where the right side is not positive.
#pragma once

#include <array>
#include <cmath>

#include "sim/parameter.hpp"
#include "sim/plant/friction/body.hpp"

namespace stiction::sim {

class Parabolic {
 public:
  struct Parameters {
    double force_at_1_m_per_s = 0.0;
    double order = 1.0;
    double coulomb = 0.0;  // these two by effects alone
    double viscous = 0.0;
  };
  static constexpr std::string_view name = "parabolic";
  static constexpr std::string_view label = "B2 parabolic";
  static constexpr std::array<Parameter<Parameters>, 2> parameters{{
      {"force_at_1_m_per_s", "N", not_negative(), &Parameters::force_at_1_m_per_s, {}, "friction a at 1 m/s"},
      {"order", "1", {1.0, 20.0}, &Parameters::order, {}, "order n of the root"},
  }};

  Parabolic(const Parameters& p, Body body)
      : p_(p), gain_(body.step / body.mass), slope_(gain_ * p.force_at_1_m_per_s), inertia_(1.0 + gain_ * p.viscous) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double free = velocity + gain_ * force;
    const double target = std::abs(free) - gain_ * p_.coulomb;
    if (target <= 0.0) return 0.0;
    if (slope_ == 0.0) return std::copysign(target / inertia_, free);
    // Both terms alone bound the root from above; from there Newton's steps on a convex function fall to it.
    double s = std::min(std::pow(target, 1.0 / p_.order), target / slope_);
    for (int i = 0; i < 60; ++i) {
      const double power = std::pow(s, p_.order - 1.0);
      const double next = s - (inertia_ * power * s + slope_ * s - target) / (p_.order * inertia_ * power + slope_);
      if (!(next < s) || s - next < 1e-13 * s) break;
      s = next;
    }
    return std::copysign(std::pow(s, p_.order), free);
  }

 private:
  Parameters p_;
  double gain_;
  double slope_;
  double inertia_;
};

}  // namespace stiction::sim
