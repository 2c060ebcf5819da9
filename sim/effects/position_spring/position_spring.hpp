// A force proportional to the position: F = -stiffness (x - neutral). Cable carrier, bellows, hose.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class PositionSpring {
 public:
  struct Parameters {
    double stiffness = 0.0;
    double neutral = 0.0;
  };
  static constexpr std::string_view name = "position_spring";
  static constexpr std::string_view text = "a force proportional to position: cable carrier, bellows, hose";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 2> parameters{{
      {"stiffness",
       "N/m",
       machine::any_value(),
       &Parameters::stiffness,
       {},
       "stiffness; positive pulls towards neutral"},
      {"neutral", "m", machine::any_value(), &Parameters::neutral, {}, "position without force"},
  }};
  static constexpr bool is_friction = false;

  PositionSpring(const Parameters& p, Body) : p_(p) {}

  double force(const CarriageState& s) const { return -p_.stiffness * (s.position - p_.neutral); }

 private:
  Parameters p_;
};

}  // namespace stiction::sim
