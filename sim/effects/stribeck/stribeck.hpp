// Friction that falls with speed near standstill: extra friction break_away exp(-(v/velocity)^2) sgn v (Stribeck 1902
// in the form of Bo and Pavelescu 1982 with exponent 2). sgn v is the direction of carriage_state.hpp.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class Stribeck {
 public:
  struct Parameters {
    double break_away = 0.0;
    double velocity = 0.0;
  };
  static constexpr std::string_view name = "stribeck";
  static constexpr std::string_view text = "friction that falls with speed near standstill";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"break_away",
       "N",
       machine::any_value(),
       &Parameters::break_away,
       {},
       "friction near standstill above Coulomb's"},
      {"velocity", "m/s", machine::positive(), &Parameters::velocity, {}, "speed at which 37 % of it is left"},
  }};
  static constexpr bool is_friction = true;

  Stribeck(const Parameters& p, Body) : break_away_(p.break_away), per_velocity_(1.0 / p.velocity) {}

  double force(const CarriageState& s) const {
    const double ratio = s.velocity * per_velocity_;
    return -break_away_ * std::exp(-ratio * ratio) * s.direction;
  }

 private:
  double break_away_;
  double per_velocity_;
};

}  // namespace stiction::sim
