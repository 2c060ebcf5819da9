// The time in which clients may write parameters: closed until the operator of this computer opens it (SIGUSR1), and
// closed again by itself, or by SIGUSR2. Of a clock that no setting of the time of day moves. Any thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace stiction::drive {

class CommissioningWindow {
 public:
  // `length_s`: for which it stays open; 0: it cannot be opened.
  explicit CommissioningWindow(double length_s) : length_ns_(static_cast<std::int64_t>(length_s * 1e9)) {}

  void open(std::int64_t now_ns) { end_ns_.store(now_ns + length_ns_); }
  void close() { end_ns_.store(INT64_MIN); }
  bool is_open(std::int64_t now_ns) const { return now_ns < end_ns_.load(); }
  // Seconds until it closes, rounded up; 0: it is closed.
  std::uint32_t seconds_left(std::int64_t now_ns) const {
    const std::int64_t end_ns = end_ns_.load();
    if (now_ns >= end_ns) return 0;
    return static_cast<std::uint32_t>((end_ns - now_ns + 999'999'999) / 1'000'000'000);
  }
  double length_s() const { return static_cast<double>(length_ns_) * 1e-9; }

 private:
  std::int64_t length_ns_;
  std::atomic<std::int64_t> end_ns_ = INT64_MIN;
};

}  // namespace stiction::drive
