// Friction that rises less than linearly with speed: extra friction force (1 - exp(-|v|/velocity)) sgn v. A negative
// force makes it rise more than linearly. The law has no jump at standstill.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class ViscousNonlinear {
 public:
  struct Parameters {
    double force = 0.0;
    double velocity = 0.0;
  };
  static constexpr std::string_view name = "viscous_nonlinear";
  static constexpr std::string_view text = "friction that rises less, or more, than linearly with speed";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"force", "N", machine::any_value(), &Parameters::force, {}, "extra friction at high speed; negative: less"},
      {"velocity", "m/s", machine::positive(), &Parameters::velocity, {}, "speed at which 63 % of it is reached"},
  }};
  static constexpr bool is_friction = true;

  ViscousNonlinear(const Parameters& p, Body body)
      : slope_(p.force / p.velocity), per_velocity_(1.0 / p.velocity), body_(body) {}

  // The share of it that is there at `ratio` times that speed, not negative.
  static double risen(double ratio) { return one_minus_exp(ratio); }

  // force risen(|v|/velocity) sgn v, as a slope at this speed.
  double force(const CarriageState& s) const {
    return damping_force(slope_ / relaxation_divisor(std::abs(s.velocity) * per_velocity_), s.velocity, body_);
  }

 private:
  double slope_;  // N s/m, at standstill
  double per_velocity_;
  Body body_;
};

}  // namespace stiction::sim
