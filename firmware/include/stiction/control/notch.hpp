// Notch filter (Mendricky 2006, 3.19) as a biquad in transposed direct form II:
//   y = b0 x + s1;  s1' = b1 x - a1 y + s2;  s2' = b2 x - a2 y.
// The memories are exact, so that this is to the bit the direct form, with half of its memory traffic. The rounding
// remainder of each output enters the next sum: the gain at standstill is exact and a low notch frequency leaves no
// dead band.
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
  using Term = decltype(Coefficient{} * Signal{});
  using Memory2 = decltype(Term{} - Term{});
  using Memory1 = decltype(Memory2{} + Memory2{} + typename S::FilterResidue{});
  struct State {
    Memory1 s1{};
    Memory2 s2{};
  };

  // One tick of the filter. `config`: its coefficients; `state`: the last inputs and outputs, changed by the step; `x`:
  // input, in the unit of the signal; `saturations`: counts outputs that exceed the format.
  static constexpr Signal step(const Config& config, State& state, Signal x, SaturationCounter& saturations) {
    if (!config.enabled) return x;
    const auto exact = config.b0 * x + state.s1;
    const Signal y = narrow<Signal>(exact, saturations);
    state.s1 = config.b1 * x - config.a1 * y + state.s2 + S::filter_residue(exact, y);
    state.s2 = config.b2 * x - config.a2 * y;
    return y;
  }
};

}  // namespace stiction
