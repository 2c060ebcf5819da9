// The brake that holds an axis without power: it has its time to open before the axis moves, and to close before the
// power goes.
#pragma once

#include <cstdint>

namespace stiction {

class HoldingBrake {
 public:
  // The power comes, or a stop is taken back. `brake_ticks`: that the brake takes.
  constexpr void open(std::uint32_t brake_ticks) {
    closing_ = false;
    hold_ticks_ = brake_ticks;
    rest_ticks_ = 0;
  }

  // Once a tick of an axis that is to move: whether it still opens.
  constexpr bool opens() {
    if (hold_ticks_ == 0) return false;
    --hold_ticks_;
    return true;
  }

  // Once a tick from when the set-point has come to rest: whether it is closed. It closes when the carriage is at rest,
  // or the margin is over. `standing`: the carriage; `margin_ticks`: that it has for that; `brake_ticks`: as of open().
  constexpr bool close(bool standing, std::uint32_t margin_ticks, std::uint32_t brake_ticks) {
    if (!closing_) {
      ++rest_ticks_;
      closing_ = standing || rest_ticks_ > margin_ticks;
      hold_ticks_ = brake_ticks;
    }
    if (!closing_) return false;
    if (hold_ticks_ == 0) return true;
    --hold_ticks_;
    return false;
  }

  constexpr bool closing() const { return closing_; }

 private:
  std::uint32_t hold_ticks_ = 0, rest_ticks_ = 0;
  bool closing_ = false;
};

}  // namespace stiction
