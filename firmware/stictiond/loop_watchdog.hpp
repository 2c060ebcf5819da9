// Watches that the control loop makes progress, in a thread that does nothing else: no log, no service manager, no
// lock. Where the loop stands still for longer than the limit the power is cut beside it (hal/power_cut.hpp): fault 51.
// The loop itself, where it goes on, takes note of that in its next tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "firmware/stictiond/service_notify.hpp"
#include "hal/power_cut.hpp"
#include "stiction/drive/faults.hpp"

namespace stiction::drive {

// One look at the loop, without the thread.
class LoopWatch {
 public:
  // `limit_ns`: for which the loop may stand still; `cut`: what to do then.
  LoopWatch(std::int64_t limit_ns, hal::PowerCut& cut) : watch_(limit_ns), cut_(cut) {}

  // `progress`: ticks of the loop, 0: it has not begun and is not watched; `now_ns`: of the monotonic clock. The first
  // call behind that only starts the watch.
  void look(std::uint64_t progress, std::int64_t now_ns) {
    if (progress == 0) return;
    watch_.moved(progress, now_ns);
    if (watch_.starved()) cut_.cut();
  }

 private:
  ProgressWatch watch_;
  hal::PowerCut& cut_;
};

class LoopWatchdog {
 public:
  static constexpr std::int64_t limit_ns = 100'000'000;  // as long as the longest gap that a clock may have
  // A look sees progress up to a round late, and the limit exceeded up to a round later: 110 ms in all.
  static constexpr std::int64_t round_ns = 5'000'000;
  // Looks are at multiples of the round of the monotonic clock, where the kernel may have its own tick and the loop has
  // none (hal/tick_clock.hpp): above the loop's priority, a look at its deadline would hold up that tick.
  static constexpr std::int64_t first_look_ns(std::int64_t now_ns) { return (now_ns / round_ns + 1) * round_ns; }

  // `progress`, `cut`: see LoopWatch, the first safe beside the loop; `priority`: of SCHED_FIFO of the loop, above
  // which the thread runs where that is allowed; 0: an ordinary one. Made before the loop's thread takes a processor
  // for itself.
  LoopWatchdog(std::function<std::uint64_t()> progress, hal::PowerCut& cut, int priority);
  ~LoopWatchdog();
  LoopWatchdog(const LoopWatchdog&) = delete;
  LoopWatchdog& operator=(const LoopWatchdog&) = delete;
  LoopWatchdog(LoopWatchdog&&) = delete;
  LoopWatchdog& operator=(LoopWatchdog&&) = delete;

 private:
  void run(int priority);

  std::function<std::uint64_t()> progress_;
  LoopWatch watch_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

// One tick of a programme over a loop that may have been cut since the last one: the loop then trips fault 51 for every
// axis, and the gate opens again once they are off; they remain so until the fault is reset. After a suspension of the
// computer it trips fault 49. `programme`, `loop`: of the tick; `cut`: of the process; `stop_wanted`: a controlled
// stop, then the end; `suspended`: whether the computer was suspended since the last tick, which no time of a tick
// shows.
template <class Programme, class Loop>
void tick_under_watch(Programme& programme, Loop& loop, hal::PowerCut& cut, bool stop_wanted, bool suspended) {
  const bool was_cut = cut.is_cut();
  if (suspended) loop.trip(Fault::clock_jump);
  if (was_cut) loop.trip(Fault::watchdog_starved);
  programme.tick(stop_wanted);
  if (was_cut) cut.release();
}

}  // namespace stiction::drive
