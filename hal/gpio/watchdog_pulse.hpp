// The pulse for a watchdog outside of the computer: a level that changes once a period, as long as the loop goes on to
// ask for it. Whatever stops the loop, the kernel or the computer stops it, at either level: the watchdog has to look
// for edges, not for a level.
#pragma once

#include <cstdint>

namespace stiction::hal {

class WatchdogPulse {
 public:
  // `period_ns`: from one edge to the next, above 0.
  explicit constexpr WatchdogPulse(std::int64_t period_ns) : period_ns_(period_ns) {}

  // The level of the line in a tick; to be asked in each, behind the tick's work. `now_ns`: time of the tick. An edge
  // that is late moves those behind it: two are never closer than a period.
  constexpr bool step(std::int64_t now_ns) {
    if (now_ns - edge_ns_ >= period_ns_) {
      level_ = !level_;
      edge_ns_ = now_ns;
    }
    return level_;
  }

 private:
  std::int64_t period_ns_;
  std::int64_t edge_ns_ = 0;
  bool level_ = false;
};

}  // namespace stiction::hal
