// A time that only tests move: sleeping moves it to the end of the sleep and on by what the test lets it be late.
#pragma once

#include <cstdint>
#include <deque>

namespace stiction::test {

struct FakeClock {
  std::int64_t now_ns = 1'000'000'000;
  std::deque<std::int64_t> late_ns;      // of the next sleeps; 0 when there are no more
  std::int64_t work_per_reading_ns = 0;  // each reading of the clock takes so long
  std::int64_t suspended_ns = 0;         // of the computer, in all; now_ns stood still meanwhile
};

// As a clock's template argument: a copy refers to the same clock.
struct FakeTime {
  FakeClock* clock;

  std::int64_t now_ns() const {
    clock->now_ns += clock->work_per_reading_ns;
    return clock->now_ns;
  }

  std::int64_t with_suspension_ns() const {
    clock->now_ns += clock->work_per_reading_ns;
    return clock->now_ns + clock->suspended_ns;
  }

  void sleep_until(std::int64_t time_ns) const {
    if (time_ns > clock->now_ns) clock->now_ns = time_ns;
    if (clock->late_ns.empty()) return;
    clock->now_ns += clock->late_ns.front();
    clock->late_ns.pop_front();
  }
};

}  // namespace stiction::test
