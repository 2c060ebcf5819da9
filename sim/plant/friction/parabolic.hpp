// Friction model B2, parabolic (Mendricky 2006, 4.3): F = a |v|^(1/n) sgn(v). Its slope at standstill is infinite, so
// an explicit step chatters; the step is solved implicitly for s = |v|^(1/n): s^n + (h a / m) s = |v + h F / m|.
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
  };
  static constexpr std::string_view name = "parabolic";
  static constexpr std::string_view label = "B2 parabolic";
  static constexpr std::array<Parameter<Parameters>, 2> parameters{{
      {"force_at_1_m_per_s", "N", not_negative(), &Parameters::force_at_1_m_per_s, {}, "friction a at 1 m/s"},
      {"order", "1", {1.0, 20.0}, &Parameters::order, {}, "order n of the root"},
  }};

  Parabolic(const Parameters& p, Body body)
      : p_(p), gain_(body.step / body.mass), slope_(gain_ * p.force_at_1_m_per_s) {}

  // Velocity (m/s) one step later, under `force` (N), the sum of all forces but friction.
  double advance(double velocity, double force) {
    const double free = velocity + gain_ * force;
    const double target = std::abs(free);
    if (target == 0.0 || slope_ == 0.0) return free;
    // Both terms alone bound the root from above; from there Newton's steps on a convex function fall to it.
    double s = std::min(std::pow(target, 1.0 / p_.order), target / slope_);
    for (int i = 0; i < 60; ++i) {
      const double power = std::pow(s, p_.order - 1.0);
      const double next = s - (power * s + slope_ * s - target) / (p_.order * power + slope_);
      if (!(next < s) || s - next < 1e-13 * s) break;
      s = next;
    }
    return std::copysign(std::pow(s, p_.order), free);
  }

 private:
  Parameters p_;
  double gain_;
  double slope_;
};

}  // namespace stiction::sim
