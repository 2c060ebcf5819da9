// The industry's friction compensation, as a baseline: a pulse of speed set-point at each reversal of the set speed,
// into the new direction. Its amplitude follows a characteristic over the acceleration at the reversal, that of the
// Siemens 840D (MD32510 to MD32580): it rises to a1, stays to a2, falls to a3 and stays at the lowest.
#pragma once

#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct ReversalPulse {
  using Velocity = typename S::Velocity;
  using Acceleration = typename S::Acceleration;

  struct Config {
    Velocity amplitude{};           // between a1 and a2
    Velocity final_amplitude{};     // from a3 on; at most `amplitude`
    typename S::PulseSlope rise{};  // amplitude / a1
    typename S::PulseSlope fall{};  // (amplitude - final_amplitude) / (a3 - a2)
    Acceleration flat_until{};      // a2
    std::uint32_t delay_ticks = 0;  // from the reversal to the pulse
    std::uint32_t duration_ticks = 0;
  };
  struct State {
    bool forward = false;     // the last motion was in +x
    bool moved = false;       // there was one
    std::uint32_t ticks = 0;  // since the last reversal; stays at the pulse's end
    Velocity height{};        // of the pulse, with its sign
  };

  static constexpr State start(const Config& config) {
    State state;
    state.ticks = config.delay_ticks + config.duration_ticks;
    return state;
  }

  // The speed to add to the set speed in this tick. `v`, `a`: set speed, m/s, and acceleration, m/s^2. `config`:
  // amplitude, delay and duration; `state`: the pulse under way, changed by the step; `saturations`: counts results
  // that exceed the format.
  static constexpr Velocity step(const Config& config, State& state, Velocity v, Acceleration a,
                                 SaturationCounter& saturations) {
    const bool forward = v > Velocity{};
    const bool moving = forward || v < Velocity{};
    const bool reversed = moving && state.moved && forward != state.forward;
    // Worked out in every tick, so that a reversal costs no more than any other.
    const Velocity height = amplitude(config, a < Acceleration{} ? opposite(a) : a, saturations);
    const std::uint32_t end = config.delay_ticks + config.duration_ticks;
    if (moving) state.forward = forward;
    state.moved |= moving;
    state.height = reversed ? (forward ? height : opposite(height)) : state.height;
    state.ticks = reversed ? 0 : state.ticks < end ? state.ticks + 1 : end;
    return state.ticks >= config.delay_ticks && state.ticks < end ? state.height : Velocity{};
  }

  // The characteristic; `a` is not negative. `config`: the characteristic over the acceleration, m/s^2; `saturations`:
  // counts results that exceed the format.
  static constexpr Velocity amplitude(const Config& config, Acceleration a, SaturationCounter& saturations) {
    const auto beyond = saturated_difference(a, config.flat_until, saturations);
    const auto excess = beyond > Acceleration{} ? beyond : Acceleration{};
    const auto rising = narrow<Velocity>(config.rise * a, saturations);
    const auto fallen =
        saturated_difference(config.amplitude, narrow<Velocity>(config.fall * excess, saturations), saturations);
    const auto falling = fallen > config.final_amplitude ? fallen : config.final_amplitude;
    return rising < falling ? rising : falling;
  }
};

}  // namespace stiction
