// How often something may happen: a burst at once, and so many a second from then on (a token bucket). For what comes
// from outside and costs memory, a disk or a line of the log.
#pragma once

#include <algorithm>
#include <cstdint>

namespace stiction::drive {

class RateLimit {
 public:
  // `burst`: at once after silence; `per_second`: from then on.
  constexpr RateLimit(double burst, double per_second) : burst_(burst), per_second_(per_second), left_(burst) {}

  // Whether it may happen now. `now_ns`: of a clock that does not go back.
  constexpr bool take(std::int64_t now_ns) {
    left_ = std::min(burst_, left_ + static_cast<double>(now_ns - last_ns_) * 1e-9 * per_second_);
    last_ns_ = now_ns;
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double burst_, per_second_, left_;
  std::int64_t last_ns_ = 0;
};

}  // namespace stiction::drive
