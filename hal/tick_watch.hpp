// What the times of the ticks tell: ticks that were missed and a clock that jumped. Rows missed_deadline and clock_jump
// of fault_table. One missed tick is borne, two in a row or at once are not: the power stage holds its last command
// meanwhile and the axis its last sample.
#pragma once

#include <cstdint>

#include "stiction/drive/faults.hpp"

namespace stiction::hal {

class TickWatch {
 public:
  static constexpr std::int64_t longest_gap_ns = 100'000'000;
  static constexpr int late_ticks_allowed = 1;

  explicit constexpr TickWatch(std::int64_t period_ns) : period_ns_(period_ns) {}

  // Once a tick, with its time. What it finds holds for this tick.
  constexpr Fault step(std::int64_t now_ns) {
    const std::int64_t gap = started_ ? now_ns - last_ns_ : period_ns_;
    started_ = true;
    last_ns_ = now_ns;
    if (gap <= 0 || gap > longest_gap_ns) {
      late_ = 0;
      return Fault::clock_jump;
    }
    const std::int64_t missed = gap / period_ns_ - 1;  // ticks that were due in the gap
    if (missed > 0) missed_ += static_cast<std::uint64_t>(missed);
    late_ = missed > 0 ? late_ + missed : 0;
    return late_ > late_ticks_allowed ? Fault::missed_deadline : Fault::none;
  }

  // The next step is the first again, and its figures count from there: after work between two ticks that may take as
  // long as it likes.
  constexpr void restart() {
    started_ = false;
    late_ = 0;
    missed_ = 0;
  }

  constexpr std::uint64_t missed() const { return missed_; }  // ticks since the (re)start

 private:
  std::int64_t period_ns_;
  std::int64_t last_ns_ = 0;
  bool started_ = false;
  std::int64_t late_ = 0;  // ticks in a row
  std::uint64_t missed_ = 0;
};

}  // namespace stiction::hal
