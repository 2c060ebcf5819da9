// A set-point whose speed goes to a target by a constant deceleration or acceleration: the quick stop from whatever
// motion runs (target 0) and the moves of homing. The position is the trapezoid of the speed, so that both stay
// consistent, and the speed ends exactly at its target. Fixed work.
#pragma once

#include <cstdint>

#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct VelocityRamp {
  using Velocity = typename S::Velocity;

  struct Config {
    Velocity change{};  // of the speed in a tick: deceleration * period
    typename S::Seconds half_period{};
    typename S::Rate rate{};  // 1 / period
  };
  struct State {
    typename S::Position position{};
    Velocity velocity{};
  };

  // One tick. Returns the acceleration of the tick that ends in the new state. `config`: change of the speed in a tick;
  // `state`: set-point, changed by the step; `target`: speed, m/s; `saturations`: counts results that exceed the
  // format.
  static constexpr typename S::Acceleration step(const Config& config, State& state, Velocity target,
                                                 SaturationCounter& saturations) {
    const auto missing = saturated_difference(target, state.velocity, saturations);
    const auto low = negative(config.change);
    const auto below = missing > config.change ? config.change : missing;
    const auto change = below < low ? low : below;
    const auto velocity = saturated_sum(state.velocity, change, saturations);
    // Two products: the sum of both speeds is more than a word holds.
    const auto first = narrow<typename S::Step>(state.velocity * config.half_period, saturations);
    const auto second = narrow<typename S::Step>(velocity * config.half_period, saturations);
    state.position = narrow<typename S::Position>(state.position + first + second, saturations);
    state.velocity = velocity;
    return narrow<typename S::Acceleration>(change * config.rate, saturations);
  }
};

}  // namespace stiction
