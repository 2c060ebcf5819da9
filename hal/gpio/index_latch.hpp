// Where an axis was at a time, from the time-stamped positions of another encoder: the position of an index mark whose
// edge came by GPIO while the position came over a bus. Linear between the two newest samples and on from them; at
// 10 m/s^2 the straight line is off by a/8 T^2 = 5 nm within a period of 62.5 us and 1.25 um within one of 1 ms.
#pragma once

#include <cstdint>
#include <optional>

#include "stiction/drive/exchange.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

class IndexLatch {
 public:
  using Signals = FixedSignals;

  // The feedback of every tick; a sample that is not valid or not new is passed over.
  void observe(const Feedback<Signals>& feedback) {
    if (!feedback.position_valid || (samples_ > 0 && feedback.position_time_ns <= newest_.time_ns)) return;
    before_ = newest_;
    newest_ = {feedback.position.raw(), feedback.position_time_ns};
    if (samples_ < 2) ++samples_;
  }

  // None while there are no two samples, or where the time is further from the newest than they are bridged for.
  std::optional<Signals::Position> position_at(std::int64_t time_ns) const {
    if (samples_ < 2) return std::nullopt;
    const std::int64_t since = time_ns - newest_.time_ns;
    const std::int64_t apart = newest_.time_ns - before_.time_ns;
    const std::int64_t moved = newest_.raw - before_.raw;
    // 100 mm is 8 m/s for 12 ms; with it the product below stays under 2^61.
    constexpr std::int64_t most_moved = std::int64_t{1} << 37;
    if (since > longest_ns || since < -longest_ns || apart > longest_ns || moved > most_moved || moved < -most_moved)
      return std::nullopt;
    return Signals::Position::from_raw(newest_.raw + moved * since / apart);
  }

 private:
  static constexpr std::int64_t longest_ns = 10'000'000;  // below 2^24

  struct Sample {
    std::int64_t raw = 0;
    std::int64_t time_ns = 0;
  };
  Sample before_, newest_;
  int samples_ = 0;
};

}  // namespace stiction::hal
