// The level of friction changes as the machine warms up: extra friction change (1 - e^(-t/time_constant)) sgn v, t from
// `elapsed` before the start of the simulation, as a body of one thermal time constant does under a constant loss. sgn
// v is the direction of carriage_state.hpp.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class ThermalDrift {
 public:
  struct Parameters {
    double change = 0.0;
    double time_constant = 0.0;
    double elapsed = 0.0;
  };
  static constexpr std::string_view name = "thermal_drift";
  static constexpr std::string_view text = "a friction level that changes with time as the machine warms up";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"change", "N", machine::any_value(), &Parameters::change, {}, "friction when warm above friction when cold"},
      {"time_constant", "s", machine::positive(), &Parameters::time_constant, {}, "time in which 63 % of it have come"},
      {"elapsed", "s", machine::not_negative(), &Parameters::elapsed, 0.0, "time from cold to the start of the record"},
  }};
  static constexpr bool is_friction = true;

  ThermalDrift(const Parameters& p, Body) : change_(p.change), per_time_(1.0 / p.time_constant), elapsed_(p.elapsed) {}

  double force(const CarriageState& s) const {
    return change_ * std::expm1(-(s.time + elapsed_) * per_time_) * s.direction;
  }

 private:
  double change_;
  double per_time_;
  double elapsed_;  // s
};

}  // namespace stiction::sim
