// A force at a fixed frequency, whatever the motion: F = cosine cos(2 pi f t) + sine sin(2 pi f t), positive in +x, t
// from the start of the simulation. A pump, a fan, a spindle; its phase differs from record to record.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class PeriodicDisturbance {
 public:
  struct Parameters {
    double frequency = 0.0;
    double cosine = 0.0, sine = 0.0;
  };
  static constexpr std::string_view name = "periodic_disturbance";
  static constexpr std::string_view text = "a force at a fixed frequency, whatever the motion";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 3> parameters{{
      {"frequency", "Hz", machine::positive(), &Parameters::frequency, {}, "of the force"},
      {"cosine", "N", machine::any_value(), &Parameters::cosine, 0.0, "force in cos(2 pi frequency t)"},
      {"sine", "N", machine::any_value(), &Parameters::sine, 0.0, "force in sin(2 pi frequency t)"},
  }};
  static constexpr bool is_friction = false;

  PeriodicDisturbance(const Parameters& p, Body) : p_(p), rate_(2.0 * std::numbers::pi * p.frequency) {}

  double force(const CarriageState& s) const {
    return p_.cosine * std::cos(rate_ * s.time) + p_.sine * std::sin(rate_ * s.time);
  }

 private:
  Parameters p_;
  double rate_;  // rad/s
};

}  // namespace stiction::sim
