// Friction that follows the speed with a delay in sliding: its part that depends on the speed takes not v but w,
//   time dw/dt = v - w,
// of first order where Hess and Soom (1990) have a pure delay. Coulomb friction and the contact do not wait. On the
// carriage it is F = -(g(w) - g(v)), g the part of the friction model in use: viscous friction, of LuGre the fall from
// static to Coulomb friction, of Maxwell slip its rise, of the linear ramp what lies above its break velocity, of the
// parabolic model all of it.
#pragma once

#include <array>
#include <functional>

#include "sim/model/machine.hpp"
#include "sim/parameter.hpp"
#include "sim/plant/effects/carriage_state.hpp"

namespace stiction::sim {

// Friction that depends on the speed alone, N along the motion at `velocity` (m/s) with the contact pushing in
// `direction` (-1 to 1).
using SlidingFriction = std::function<double(double velocity, double direction)>;
SlidingFriction sliding_friction(const FrictionParameters& parameters);

class FrictionLag {
 public:
  struct Parameters {
    double time = 0.0;
  };
  static constexpr std::string_view name = "friction_lag";
  static constexpr std::string_view text = "friction that follows the speed with a delay in sliding";
  static constexpr bool several = false;
  static constexpr std::array<Parameter<Parameters>, 1> parameters{{
      {"time", "s", positive(), &Parameters::time, {}, "time constant by which friction follows the speed"},
  }};
  static constexpr bool is_friction = true;

  FrictionLag(const Parameters& p, Body body, const Axis& axis)
      : share_(one_minus_exp(body.step / p.time)),
        friction_(sliding_friction(axis.friction.models.at(axis.friction.use))) {}

  // One step at the velocity of `state`, which is held over it.
  void advance(const CarriageState& state) { followed_ += share_ * (state.velocity - followed_); }

  double force(const CarriageState& s) const {
    return friction_(s.velocity, s.direction) - friction_(followed_, s.direction);
  }

 private:
  double share_;
  SlidingFriction friction_;
  double followed_ = 0.0;  // w, m/s
};

}  // namespace stiction::sim
