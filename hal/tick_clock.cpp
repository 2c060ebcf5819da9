#include "hal/tick_clock.hpp"

#include <cerrno>
#include <ctime>

namespace stiction::hal {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * second_ns + now.tv_nsec;
}

void sleep_until(std::int64_t time_ns) {
  const timespec until{time_ns / second_ns, time_ns % second_ns};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

std::int64_t TickClock::wait() {
  missed_now_ = 0;
  if (!started_) {
    started_ = true;
    next_ns_ = monotonic_ns() + period_ns_;
  }
  sleep_until(next_ns_);
  const std::int64_t late = monotonic_ns() - next_ns_;
  if (late >= period_ns_) {
    missed_now_ = static_cast<std::uint64_t>(late / period_ns_);
    missed_ += missed_now_;
    next_ns_ += static_cast<std::int64_t>(missed_now_) * period_ns_;
  }
  lateness_ns_ = late;
  const std::int64_t now_ns = next_ns_;
  next_ns_ += period_ns_;
  return now_ns;
}

}  // namespace stiction::hal
