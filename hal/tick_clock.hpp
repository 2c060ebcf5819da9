// The clock of a loop on a real kernel: absolute sleeps on CLOCK_MONOTONIC, so that lateness does not add up. It says
// what the drive's programme watches of its time (faults.hpp: missed deadline, clock jump) and keeps a histogram of how
// late ticks began.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "hal/time_histogram.hpp"
#include "stiction/drive/faults.hpp"

namespace stiction::hal {

// The kernel's time, ns. Tests put another in its place, so that none depends on the machine's load.
struct MonotonicTime {
  std::int64_t now_ns() const;
  // The same, and the time in which the computer was suspended beside it (CLOCK_BOOTTIME).
  std::int64_t with_suspension_ns() const;
  void sleep_until(std::int64_t time_ns) const;
};

// The first time from `earliest_ns` on from which ticks `period_ns` apart begin while the kernel is not at its own
// tick. That comes at multiples of 1 ms or more of CLOCK_MONOTONIC (CONFIG_HZ 1000, 250 or 100) and keeps interrupts
// off for 3 us and a thread above the loop that wakes there (loop_watchdog.hpp) for 7 us: 47 us before a tick of the
// loop, and, where its period is that of the current loop or a multiple of it, 16 us behind one.
constexpr std::int64_t clear_of_kernel_tick(std::int64_t earliest_ns, std::int64_t period_ns) {
  const std::int64_t behind_ns = std::min<std::int64_t>(period_ns, 62'500) * 3 / 4;
  const std::int64_t since_ns = (earliest_ns - behind_ns) % period_ns;
  return earliest_ns + (since_ns > 0 ? period_ns - since_ns : -since_ns);
}

// Time: now_ns(), with_suspension_ns() and sleep_until(time_ns). One thread waits; missed(), jumps() and lateness() may
// be read by others.
template <class Time>
class BasicTickClock {
 public:
  // A clock that goes back, or on by more than this between two ticks, has jumped: 1600 ticks of 62.5 us, far beyond
  // what a loaded kernel makes of a sleep.
  static constexpr std::int64_t jump_ns = 100'000'000;
  // One late tick in a row is borne, its command held; a second is a fault.
  static constexpr std::uint64_t late_ticks_borne = 1;

  // `period_ns`: up to a hundredth of a second.
  explicit BasicTickClock(std::int64_t period_ns, Time time = {}) : period_ns_(period_ns), time_(time) {}

  // Sleeps until the next tick and returns its nominal time (ns). The first call starts the clock. A tick that begins
  // more than a period late takes the place of those that were due meanwhile: they are missed. After a jump the clock
  // starts again at the new time, at once; a computer that was suspended has let time pass that now_ns() does not show,
  // and counts as a jump.
  std::int64_t wait() {
    std::int64_t now = time_.now_ns();
    first_ = !started_;
    suspended_ = false;
    if (first_) start(now);
    bool jumped = jumped_since_last(now);
    if (!jumped) {
      time_.sleep_until(next_ns_);
      // In this order: without a suspension the distance is at most that of the start, however long this thread waits
      // between the two readings.
      const std::int64_t with_suspension = time_.with_suspension_ns();
      now = time_.now_ns();
      suspended_ = with_suspension - now > suspension_ns_;
      if (suspended_) suspension_ns_ = time_.with_suspension_ns() - now;
      jumped = suspended_ || jumped_since_last(now);
    }
    missed_now_ = 0;
    if (jumped) {
      add(jumps_, 1);
      late_in_a_row_ = 0;
      lateness_ns_ = 0;
      fault_ = Fault::clock_jump;
      next_ns_ = now;
    } else {
      lateness_.add(now - next_ns_);
      count_missed(now - next_ns_);
      fault_ = late_in_a_row_ > late_ticks_borne ? Fault::missed_deadline : Fault::none;
    }
    last_ns_ = now;
    const std::int64_t tick_ns = next_ns_;
    next_ns_ += period_ns_;
    if (jumped) next_ns_ = start_from(next_ns_);
    return tick_ns;
  }

  // Whenever the clock starts from here on, its ticks are clear of the kernel's own: of a loop that is alone in time.
  void keep_clear_of_kernel_tick() { clear_ = true; }

  // All ticks to come are so much later (ns, a small part of the period): of a loop that follows another clock.
  void shift(std::int64_t later_ns) { next_ns_ += later_ns; }

  // The next wait() starts the clock again, and its figures count from there: after work between two ticks that may
  // take as long as it likes. Before other threads read the figures.
  void restart() {
    started_ = false;
    fault_ = Fault::none;
    lateness_ns_ = 0;
    missed_now_ = 0;
    missed_.store(0, std::memory_order_relaxed);
    jumps_.store(0, std::memory_order_relaxed);
    lateness_.clear();
  }

  // Whether the last wait() was the first of all, or the first after restart().
  bool first_tick() const { return first_; }

  std::int64_t period_ns() const { return period_ns_; }
  // Of the last tick: a missed deadline where it and the one before began later than a period (or two were left out at
  // once), a clock jump, or none. The next tick in time has none again.
  Fault fault() const { return fault_; }
  // Whether the computer was suspended before the last tick; its time then shows no jump, as the clock stood still.
  bool was_suspended() const { return suspended_; }
  std::int64_t lateness_ns() const { return lateness_ns_; }    // of the last tick, after the time that wait() gave
  std::uint64_t missed_before() const { return missed_now_; }  // ticks missed right before the last one
  std::uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }  // ticks, since the (re)start
  std::uint64_t jumps() const { return jumps_.load(std::memory_order_relaxed); }    // of the clock
  const TimeHistogram& lateness() const { return lateness_; }                       // of every tick, jumps left out

 private:
  void start(std::int64_t now) {
    started_ = true;
    last_ns_ = now;
    next_ns_ = start_from(now + period_ns_);
    late_in_a_row_ = 0;
    suspension_ns_ = time_.with_suspension_ns() - now;  // and what passed between the two readings
  }

  std::int64_t start_from(std::int64_t earliest_ns) const {
    return clear_ ? clear_of_kernel_tick(earliest_ns, period_ns_) : earliest_ns;
  }

  bool jumped_since_last(std::int64_t now) const { return now < last_ns_ || now - last_ns_ > jump_ns; }

  void count_missed(std::int64_t late) {
    lateness_ns_ = late;
    if (late < period_ns_) {
      late_in_a_row_ = 0;
      return;
    }
    lateness_ns_ = late % period_ns_;
    missed_now_ = static_cast<std::uint64_t>(late / period_ns_);
    late_in_a_row_ += missed_now_;
    add(missed_, missed_now_);
    next_ns_ += static_cast<std::int64_t>(missed_now_) * period_ns_;
  }

  static void add(std::atomic<std::uint64_t>& counter, std::uint64_t increment) {
    counter.store(counter.load(std::memory_order_relaxed) + increment, std::memory_order_relaxed);
  }

  std::int64_t period_ns_;
  [[no_unique_address]] Time time_;
  bool clear_ = false;  // of the kernel's tick
  bool started_ = false;
  bool first_ = false;
  std::int64_t next_ns_ = 0;
  std::int64_t last_ns_ = 0;  // when the last tick began
  std::int64_t lateness_ns_ = 0;
  std::int64_t suspension_ns_ = 0;  // since the computer's start, at most
  bool suspended_ = false;
  std::uint64_t missed_now_ = 0;
  std::uint64_t late_in_a_row_ = 0;
  Fault fault_ = Fault::none;
  std::atomic<std::uint64_t> missed_ = 0;
  std::atomic<std::uint64_t> jumps_ = 0;
  TimeHistogram lateness_;
};

using TickClock = BasicTickClock<MonotonicTime>;

}  // namespace stiction::hal
