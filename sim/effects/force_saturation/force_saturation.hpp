// The motor's force grows less than its current: F = K_F I_s tanh(I / I_s), I_s = `current`, as the iron's flux
// saturates. What the windings take of it (inductance and back EMF that fall) is left out.
#pragma once

#include <array>
#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

class ForceSaturation {
 public:
  struct Parameters {
    double current = 0.0;
  };
  static constexpr std::string_view name = "force_saturation";
  static constexpr std::string_view text = "force that grows less than the current at high current";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"current", "A", machine::positive(), &Parameters::current, {}, "I_s of F = K_F I_s tanh(I / I_s)", "V"},
  }};

  // `axis` as plant_axis() returns it.
  ForceSaturation(const Parameters& p, const machine::AxisModel& axis)
      : limit_(p.current * (axis.motor.model == machine::MotorModel::synchronous ? 1.5 * axis.motor.phase_force_constant
                                                                                 : axis.motor.force_constant)) {}

  // Force (N) of a motor that without saturation had `linear` (N).
  double of_linear(double linear) const { return limit_ * std::tanh(linear / limit_); }
  // The linear force that it takes for `force` (N); beyond 99 % of the limit as at 99 %.
  double linear_for(double force) const {
    return limit_ * std::atanh(std::copysign(std::fmin(std::abs(force) / limit_, 0.99), force));
  }

 private:
  double limit_;  // N
};

}  // namespace stiction::sim
