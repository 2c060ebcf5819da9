#include "hal/tick_clock.hpp"

#include <cerrno>
#include <ctime>

namespace stiction::hal {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

std::int64_t read(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * second_ns + now.tv_nsec;
}

}  // namespace

std::int64_t MonotonicTime::now_ns() const { return read(CLOCK_MONOTONIC); }
std::int64_t MonotonicTime::with_suspension_ns() const { return read(CLOCK_BOOTTIME); }

void MonotonicTime::sleep_until(std::int64_t time_ns) const {
  const timespec until{time_ns / second_ns, time_ns % second_ns};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace stiction::hal
