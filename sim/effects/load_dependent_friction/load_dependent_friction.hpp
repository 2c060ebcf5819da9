// Friction of a gear or screw that grows with the force that it carries to the load: extra friction coefficient |T| sgn
// v, T = m_load a + weight, of the load alone (what turns with the motor in front of the teeth is accelerated without
// them). The acceleration is that of the step before. sgn v is the direction of carriage_state.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"

namespace stiction::sim {

class LoadDependentFriction {
 public:
  struct Parameters {
    double coefficient = 0.0;
  };
  static constexpr std::string_view name = "load_dependent_friction";
  static constexpr std::string_view text = "friction that grows with the force that a transmission carries to the load";
  static constexpr bool several = false;
  // From 1 on it would hold any load.
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"coefficient", "1", {0.0, 0.9}, &Parameters::coefficient, {}, "extra friction over the transmitted force"},
  }};
  static constexpr bool is_friction = true;

  // `body`: what the plant accelerates, with the motor where `axis` is stiff; `p`: of the file.
  LoadDependentFriction(const Parameters& p, Body body, const machine::AxisModel& axis)
      : coefficient_(p.coefficient),
        step_(body.step),
        load_mass_(std::max(body.mass - (axis.elastic() ? 0.0 : axis.motor_mass), 0.0)) {}

  void advance(const CarriageState& s) {
    const double acceleration = velocity_ ? (s.velocity - *velocity_) / step_ : 0.0;
    velocity_ = s.velocity;
    transmitted_ = load_mass_ * acceleration + s.weight;
  }
  double force(const CarriageState& s) const { return -coefficient_ * std::abs(transmitted_) * s.direction; }

 private:
  double coefficient_, step_, load_mass_;
  std::optional<double> velocity_;  // m/s, at the beginning of the step before
  double transmitted_ = 0.0;        // N
};

}  // namespace stiction::sim
