// Velocity from time-stamped positions, and the set-point speed delayed to match. A difference over the interval
// (t1, t2) is the mean velocity of the interval, the velocity at its middle: it lags the newest sample by half the
// interval. Compared with an undelayed set-point this lag would be a velocity error proportional to acceleration
// (2.7 um at 48 m/min on the cross table).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stiction/number/choice.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

enum class VelocityFeedback : std::uint8_t {
  given,            // the encoder itself gives a velocity at the time of its sample
  difference,       // of the last two positions
  mean_difference,  // of two means of two positions (the EMPS controller): (x0 - x2) over the time between them
};

template <class S>
struct VelocityEstimator {
  struct State {
    typename S::Position x1{}, x2{};         // the last sample and the one before
    Each<S, std::int64_t> t1_ns{}, t2_ns{};  // their times
  };
  struct Estimate {
    typename S::Velocity velocity;
    Each<S, std::int64_t> time_ns;  // the time at which the carriage had it, in the mean
  };

  // A start at rest: as if the samples before had been the same. `x`: position, m; `t_ns`: its time stamp; `period_ns`:
  // of the samples, above 0.
  static constexpr State start(typename S::Position x, Each<S, std::int64_t> t_ns, std::int64_t period_ns) {
    return {x, x, t_ns - period_ns, t_ns - 2 * period_ns};
  }

  // The velocity that a sample newer than the state gives. The sample becomes part of the state by push(). `state`: the
  // samples before; `kind`: the method; `x`: the sample, m, and `t_ns`, its time stamp; `given`: velocity that came
  // with it, m/s, which the kind given returns; `saturations`: counts results that exceed the format.
  static constexpr Estimate estimate(const State& state, VelocityFeedback kind, typename S::Position x,
                                     Each<S, std::int64_t> t_ns, typename S::Velocity given,
                                     SaturationCounter& saturations) {
    if (kind == VelocityFeedback::given) return {given, t_ns};
    const bool mean = kind == VelocityFeedback::mean_difference;
    const auto base = mean ? state.x2 : state.x1;
    const auto base_ns = mean ? state.t2_ns : state.t1_ns;
    const auto motion = narrow<typename S::Step>(x - base, saturations);
    const auto velocity = narrow<typename S::Velocity>(motion * S::rate(t_ns - base_ns), saturations);
    return {velocity, base_ns + ((t_ns - base_ns) >> 1)};
  }

  // Makes a sample part of the `state`. `x`: position, m; `t_ns`: its time stamp, later than that of the sample before.
  static constexpr void push(State& state, typename S::Position x, Each<S, std::int64_t> t_ns) {
    state = {x, state.x1, t_ns, state.t1_ns};
  }
};

// A delay line of set-point speeds, read at a fractional number of ticks before the newest by linear interpolation.
template <class S>
struct SpeedDelay {
  static constexpr int length = 5;  // the newest and four ticks back: the shortest for a mean difference

  struct State {
    std::array<typename S::Velocity, length> past{};  // past[0] is the newest
  };

  static constexpr void push(State& state, typename S::Velocity v) {
    for (std::size_t i = length - 1; i > 0; --i) state.past[i] = state.past[i - 1];
    state.past[0] = v;
  }

  // The speed `ticks` ago.
  static constexpr typename S::Velocity at(const State& state, Each<S, int> ticks) {
    if constexpr (OneAxis<S>)
      return state.past[static_cast<std::size_t>(ticks)];
    else
      return from_places(state.past, ticks);
  }

  // Delays below 0 and beyond the line's length read its ends. `state`: the delay line; `delay`: age of the velocity
  // in ticks; `saturations`: counts results that exceed the format.
  static constexpr typename S::Velocity read(const State& state, typename S::Ticks delay,
                                             SaturationCounter& saturations) {
    const auto [whole, fraction] = S::split(delay, length - 2);
    const auto newer = at(state, whole), older = at(state, whole + 1);
    return narrow<typename S::Velocity>(newer * S::complement(fraction) + older * fraction, saturations);
  }
};

}  // namespace stiction
