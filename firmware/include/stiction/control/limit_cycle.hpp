// Recognises a loop that oscillates between its limits. An unstable gain does not run away on a drive: its limits turn
// the growth into a steady oscillation that no threshold on current or error sees. What tells it from hard but
// healthy motion is how often the output changes from one limit to the other.
#pragma once

#include <cstdint>

#include "stiction/number/choice.hpp"

namespace stiction {

template <class S>
struct LimitCycle {
  struct State {
    Each<S, int> side{};               // the limit that was touched last, -1 or 1
    Each<S, std::uint32_t> changes{};  // from one limit to the other in this window
  };

  // Changes within a window that make a fault: no machine motion reverses its full force at 48 Hz.
  static constexpr std::uint32_t changes_allowed = 12;

  // One tick of the window in which the changes of several outputs are counted; begins the next one after
  // `window_ticks`. `ticks_left`: of the window, changed by the call; `window_ticks`: its length, above 0; `states`:
  // the watches, whose counts are cleared at the end of the window.
  template <class... States>
  static constexpr void advance_window(std::int32_t& ticks_left, std::uint32_t window_ticks, States&... states) {
    if (--ticks_left < 0) {
      ticks_left = static_cast<std::int32_t>(window_ticks) - 1;
      ((states.changes = {}), ...);
    }
  }

  // `side`: -1, 0 or 1, the limit that holds the output back in this tick. True when the window has too many changes.
  static constexpr Each<S, bool> step(State& state, Each<S, int> side) {
    state.changes += side * state.side < 0;
    if constexpr (OneAxis<S>)
      state.side = side != 0 ? side : state.side;
    else
      state.side = select(side != 0, side, state.side);
    return state.changes > changes_allowed;
  }
};

}  // namespace stiction
