// Notch filter (Mendricky 2006, 3.19) as a biquad in direct form I:
//   y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2.
// The rounding remainder of each output enters the next sum, so that the gain at standstill is exact and a low notch
// frequency leaves no dead band.
#pragma once

#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct Notch {
  using Signal = typename S::Current;
  using Coefficient = typename S::FilterCoefficient;

  struct Config {
    bool enabled = false;
    Coefficient b0{}, b1{}, b2{}, a1{}, a2{};
  };
  struct State {
    Signal x1{}, x2{}, y1{}, y2{};
    typename S::FilterResidue residue{};
  };

  static constexpr Signal step(const Config& config, State& state, Signal x, SaturationCounter& saturations) {
    if (!config.enabled) return x;
    const auto sum =
        config.b0 * x + config.b1 * state.x1 + config.b2 * state.x2 - config.a1 * state.y1 - config.a2 * state.y2;
    const auto exact = sum + state.residue;
    const Signal y = narrow<Signal>(exact, saturations);
    // A saturated output leaves a remainder beyond its type's range; that is dropped without counting it twice.
    SaturationCounter dropped;
    state = {x, state.x1, y, state.y1, narrow<typename S::FilterResidue>(exact - y, dropped)};
    return y;
  }
};

}  // namespace stiction
