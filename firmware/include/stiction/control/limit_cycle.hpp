// Recognises a loop that oscillates between its limits. An unstable gain does not run away on a drive: its limits turn
// the growth into a steady oscillation that no threshold on current or error sees. What tells it from hard but
// healthy motion is how often the output changes from one limit to the other.
#pragma once

#include <cstdint>

namespace stiction {

struct LimitCycle {
  struct State {
    std::int32_t side = 0;        // the limit that was touched last, -1 or 1
    std::uint32_t changes = 0;    // from one limit to the other in this window
    std::int32_t ticks_left = 0;  // of this window
  };

  // Changes within a window that make a fault: no machine motion reverses its full force at 48 Hz.
  static constexpr std::uint32_t changes_allowed = 12;

  // `side`: -1, 0 or 1, the limit that holds the output back in this tick. True when the window has too many changes.
  static constexpr bool step(State& state, int side, std::uint32_t window_ticks) {
    if (--state.ticks_left < 0) {
      state.ticks_left = static_cast<std::int32_t>(window_ticks) - 1;
      state.changes = 0;
    }
    state.changes += side * state.side < 0;
    state.side = side != 0 ? side : state.side;
    return state.changes > changes_allowed;
  }
};

}  // namespace stiction
