// The clock of a loop on a real kernel: absolute sleeps on CLOCK_MONOTONIC, so that lateness does not add up.
#pragma once

#include <cstdint>

namespace stiction::hal {

class TickClock {
 public:
  explicit TickClock(std::int64_t period_ns) : period_ns_(period_ns) {}

  // Sleeps until the next tick and returns its nominal time (ns, CLOCK_MONOTONIC). The first call starts the clock. A
  // tick that begins more than a period late takes the place of those that were due meanwhile: they are missed.
  std::int64_t wait();

  std::int64_t period_ns() const { return period_ns_; }
  std::uint64_t missed() const { return missed_; }             // ticks, since the start
  std::int64_t lateness_ns() const { return lateness_ns_; }    // of the last tick, after its nominal time
  std::uint64_t missed_before() const { return missed_now_; }  // ticks missed right before the last one

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_ = 0;
  bool started_ = false;
  std::uint64_t missed_ = 0;
  std::uint64_t missed_now_ = 0;
  std::int64_t lateness_ns_ = 0;
};

}  // namespace stiction::hal
