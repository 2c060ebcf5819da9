// The encoder of a shaft on a bus as a master: it says a position each so many ticks, which wraps with its range, and
// each tick is to know one in between. The position shown goes evenly to the newest one, which it reaches a period
// behind its arrival, and on beyond it where the next is late; at a constant speed nothing of the bus is left in it.
// That it is a period old is known, and what the look-ahead of the estimator behind it is for (master_estimator.hpp).
//
// Counts are whole numbers and stay so: nothing drifts however long the shaft turns.
#pragma once

#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

class MasterEncoder {
 public:
  static constexpr int time_bits = 16;  // 2^-16 ticks
  static constexpr int part_bits = 20;  // 2^-20 counts
  static constexpr std::int64_t longest_cycle = std::int64_t{1} << 40;

  struct Config {
    std::int64_t range = std::int64_t{1} << 32;            // counts after which it begins anew, up to 2^32
    std::int64_t cycle = 1;                                // counts of a cycle of the master, up to longest_cycle
    std::int64_t period = std::int64_t{1} << time_bits;    // from one position to the next, 2^-16 ticks, up to 2^36
    std::int64_t patience = std::int64_t{3} << time_bits;  // without a position, after which it is lost
    std::int64_t most = 1;  // counts in a period, up to half the range and 2^30: more is a jump
  };

  // Where it is: whole cycles, and 2^-20 counts from the begin of one.
  struct Place {
    std::int64_t cycles = 0;
    std::int64_t part = 0;
    bool valid = false;
  };

  explicit constexpr MasterEncoder(const Config& config) : config_(config) {}

  // A position that the encoder said. `value`: counts; `age`: how long before the coming tick it came, 2^-16 ticks.
  constexpr void take(std::uint32_t value, std::int64_t age) {
    const std::int64_t newest = value % config_.range;
    if (known_ == 0) {
      put(newest);
    } else {
      std::int64_t way = newest - value_;
      if (way >= config_.range / 2) way -= config_.range;
      if (way < -(config_.range / 2)) way += config_.range;
      // One that was not heard for a while may have gone so much farther.
      const bool jumps = magnitude(way) > static_cast<std::uint64_t>(config_.most) * (1 + unheard_periods());
      value_ = newest;
      at_ += way;
      ahead_ = jumps ? 0 : ahead_ - (way << part_bits);
      const std::int64_t half = config_.period / 2;
      // From the tick before the coming one to a period behind its arrival.
      const std::int64_t left = tick_length + config_.period - (age < half ? age : half);
      slope_ = Span::of(left).divide(-ahead_, time_bits);
    }
    turn();
    known_ = known_ < 2 ? known_ + 1 : 2;
    unheard_ = (age < config_.period ? age : config_.period) - tick_length;
  }

  // What the encoder says of itself: `broken` until it says that it is not.
  constexpr void say(bool broken) { broken_ = broken; }

  // The place of the coming tick, behind what was taken for it.
  constexpr Place step() {
    unheard_ += tick_length;
    if (unheard_ > config_.patience || broken_) known_ = 0;
    ahead_ += slope_;
    const std::int64_t part = (at_ << part_bits) + ahead_, cycle = config_.cycle << part_bits;
    const std::int64_t turns = whole(part, cycle);
    return {cycles_ + turns, part - turns * cycle, known_ == 2};
  }

 private:
  static constexpr std::int64_t tick_length = std::int64_t{1} << time_bits;

  static constexpr std::int64_t whole(std::int64_t x, std::int64_t by) { return x / by - (x % by < 0 ? 1 : 0); }

  constexpr std::uint64_t unheard_periods() const {
    return unheard_ < config_.period ? 0 : static_cast<std::uint64_t>(unheard_ / config_.period);
  }
  // At a value, with no speed.
  constexpr void put(std::int64_t value) {
    value_ = at_ = value;
    cycles_ = ahead_ = slope_ = 0;
  }
  // Whole cycles out of the counts.
  constexpr void turn() {
    const std::int64_t turns = whole(at_, config_.cycle);
    cycles_ += turns;
    at_ -= turns * config_.cycle;
  }

  Config config_;
  std::int64_t value_ = 0;    // the newest, counts of its range
  std::int64_t cycles_ = 0;   // of the newest
  std::int64_t at_ = 0;       // its counts in the cycle
  std::int64_t ahead_ = 0;    // of it, what is shown: 2^-20 counts
  std::int64_t slope_ = 0;    // of that, a tick
  std::int64_t unheard_ = 0;  // 2^-16 ticks since the newest
  int known_ = 0;             // positions in a row, up to 2
  bool broken_ = false;
};

}  // namespace stiction
