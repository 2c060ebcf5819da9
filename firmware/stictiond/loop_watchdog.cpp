#include "firmware/stictiond/loop_watchdog.hpp"

#include <sched.h>

#include <algorithm>
#include <utility>

#include "hal/tick_clock.hpp"

namespace stiction::drive {

LoopWatchdog::LoopWatchdog(std::function<std::uint64_t()> progress, hal::PowerCut& cut, int priority)
    : progress_(std::move(progress)), watch_(limit_ns, cut), thread_([this, priority] { run(priority); }) {}

LoopWatchdog::~LoopWatchdog() {
  end_ = true;
  thread_.join();
}

void LoopWatchdog::run(int priority) {
  if (priority > 0) {
    const sched_param above{std::min(priority + 1, ::sched_get_priority_max(SCHED_FIFO))};
    ::sched_setscheduler(0, SCHED_FIFO, &above);
  }
  const hal::MonotonicTime time;
  for (std::int64_t look_ns = first_look_ns(time.now_ns()); !end_; look_ns += round_ns) {
    time.sleep_until(look_ns);
    watch_.look(progress_(), time.now_ns());
  }
}

}  // namespace stiction::drive
