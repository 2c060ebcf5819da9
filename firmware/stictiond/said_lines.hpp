// Lines for the log from threads that must not wait for it, limited in number: what clients do is said as long as it is
// little, then it is counted.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "firmware/stictiond/rate_limit.hpp"

namespace stiction::drive {

class SaidLines {
 public:
  static constexpr double burst = 100, per_second = 10;

  // From any thread but the loop's. `now_ns`: of a clock that does not go back.
  void say(std::string line, std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (limit_.take(now_ns))
      lines_.push_back(std::move(line));
    else
      ++unsaid_;
  }

  // What was said since the last call and, once a second, how much was not. `now_ns`: as above.
  std::vector<std::string> take(std::int64_t now_ns) {
    constexpr std::int64_t second_ns = 1'000'000'000;
    const std::lock_guard lock(mutex_);
    if (unsaid_ == 0 || now_ns - counted_ns_ < second_ns) return std::exchange(lines_, {});
    counted_ns_ = now_ns;
    lines_.push_back(std::to_string(unsaid_) + " further messages of clients were not logged");
    unsaid_ = 0;
    return std::exchange(lines_, {});
  }

 private:
  std::mutex mutex_;
  RateLimit limit_{burst, per_second};
  std::vector<std::string> lines_;
  std::uint64_t unsaid_ = 0;
  std::int64_t counted_ns_ = 0;
};

}  // namespace stiction::drive
