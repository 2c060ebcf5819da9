// A constant force on the carriage, positive in +x: F = force. Gravity, an unbalanced weight, or the offset of a
// current sensor seen as force.
#pragma once

#include <array>

#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class ConstantForce {
 public:
  struct Parameters {
    double force = 0.0;
  };
  static constexpr std::string_view name = "constant_force";
  static constexpr std::string_view text = "a constant force: gravity, unbalanced weight, offset of the current sensor";
  static constexpr bool several = true;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"force", "N", machine::any_value(), &Parameters::force, {}, "force on the carriage, positive in +x"},
  }};
  static constexpr bool is_friction = false;

  ConstantForce(const Parameters& p, Body) : force_(p.force) {}

  double force(const CarriageState&) const { return force_; }

 private:
  double force_;
};

}  // namespace stiction::sim
