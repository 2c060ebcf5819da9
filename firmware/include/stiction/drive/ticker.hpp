// The two rates of the loop: every tick is a fast one, every ratio-th also a slow one, the first included.
#pragma once

#include <cstdint>

namespace stiction {

class Ticker {
 public:
  explicit constexpr Ticker(std::int64_t fast_period_ns, std::uint32_t ratio)
      : period_ns_(fast_period_ns), ratio_(ratio) {}

  constexpr std::int64_t period_ns() const { return period_ns_; }
  constexpr std::int64_t now_ns() const { return now_ns_; }  // logical time of the current tick
  constexpr bool slow() const { return phase_ == 0; }

  constexpr void advance() {
    now_ns_ += period_ns_;
    ++phase_;
    if (phase_ == ratio_) phase_ = 0;
  }

 private:
  std::int64_t period_ns_;
  std::uint32_t ratio_;
  std::int64_t now_ns_ = 0;
  std::uint32_t phase_ = 0;
};

}  // namespace stiction
