// Friction that follows the speed with a delay in sliding: its part that depends on the speed takes not v but w,
//   time dw/dt = v - w,
// of first order where Hess and Soom (1990) have a pure delay. On the carriage it is F = -(g(w) - g(v)), g the steady
// friction of the law in use; what does not depend on the speed does not wait.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/parameter.hpp"
#include "sim/effects/carriage_state.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::sim {

class FrictionLag {
 public:
  struct Parameters {
    double time = 0.0;
  };
  static constexpr std::string_view name = "friction_lag";
  static constexpr std::string_view text = "friction that follows the speed with a delay in sliding";
  static constexpr bool several = false;
  static constexpr std::array<machine::Parameter<Parameters>, 1> parameters{{
      {"time", "s", machine::positive(), &Parameters::time, {}, "time constant by which friction follows the speed"},
  }};
  static constexpr bool is_friction = true;

  // `p`: its time constant; `body`: the carriage; `axis`: with the friction law in use.
  FrictionLag(const Parameters& p, Body body, const machine::AxisModel& axis)
      : share_(one_minus_exp(body.step / p.time)),
        friction_(steady_friction(axis.friction)),
        most_(0.5 * body.mass / body.step) {}

  // One step at the velocity of `state`, which is held over it.
  void advance(const CarriageState& state) { followed_ += share_ * (state.velocity - followed_); }

  double force(const CarriageState& s) const { return part(s.velocity, s.direction) - part(followed_, s.direction); }

 private:
  // The part that depends on the speed, N. Limited to half of what stops the carriage in one step, as damping_force():
  // a law whose slope at standstill is infinite must not make it chatter.
  double part(double velocity, double direction) const {
    const double bound = most_ * std::abs(velocity);
    return std::clamp(friction_(velocity, direction) - friction_(0.0, direction), -bound, bound);
  }

  double share_;
  SteadyFriction friction_;
  double most_;            // N s/m
  double followed_ = 0.0;  // w, m/s
};

}  // namespace stiction::sim
