// Speed and acceleration of a measured master, whose encoder has steps: differences of its counts would shake a slave
// through its feedforwards. A tracking filter with three equal poles (fading-memory filter of second degree, "g-h-k":
// N. Morrison, "Tracking Filter Engineering", 2013, 7) follows position, speed and acceleration. A master of constant
// acceleration is followed without any lag; a change of it is seen within some 2^bits ticks.
//
// With the pole 1 - q, q = 2^-bits, and e what the measured position is ahead of the predicted one,
//   x += (3 q - 3 q^2 + q^3) e,  v += (3 q^2 - 3/2 q^3) e,  a += q^3 e,
// which are shifts alone. Fixed work.
#pragma once

#include <cstdint>

#include "stiction/motion/master_position.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

class MasterEstimator {
 public:
  static constexpr int most_bits = 12;

  struct Config {
    int bits = 7;  // 1 to most_bits
    std::int64_t half_count =
        0;                  // 2^-64 cycles: an encoder's count is at its lower end, and the shaft half of it ahead
    std::int64_t jump = 0;  // 2^-64 cycles, up to 2^59: further off the predicted position no master can be
    std::int32_t look_ahead = 0;  // 2^-16 ticks: how much later the slave's loop acts
  };

  explicit constexpr MasterEstimator(const Config& config) : config_(config) {}

  // At `position`, with a `velocity`, 2^-64 cycles a tick.
  constexpr void start(const MasterPosition& position, std::int64_t velocity = 0) {
    position_ = position + MasterPosition::fine(config_.half_count);
    velocity_ = velocity;
    acceleration_ = 0;
  }

  // Takes the `measured` position of a tick. False where the master jumped; the estimate then goes on as predicted.
  constexpr bool step(const MasterPosition& measured) {
    const MasterPosition predicted = position_ + MasterPosition::fine(velocity_ + acceleration_ / 2);
    const MasterPosition off = measured + MasterPosition::fine(config_.half_count) - predicted;
    const auto e = static_cast<std::int64_t>(off.phase);
    const bool follows = off.cycles == (e < 0 ? -1 : 0) && magnitude(e) <= static_cast<std::uint64_t>(config_.jump);
    const std::int64_t used = follows ? e : 0;
    const int q = config_.bits;
    const std::int64_t first = rounded(used, q), second = rounded(used, 2 * q), third = rounded(used, 3 * q);
    position_ = predicted + MasterPosition::fine(3 * first - 3 * second + third);
    velocity_ += acceleration_ + 3 * second - third - third / 2;
    acceleration_ += third;
    return follows;
  }

  // The master as the loop's delay makes it: `look_ahead` later.
  constexpr MasterPoint point() const {
    const std::int64_t ahead = config_.look_ahead, change = product<16>(acceleration_, ahead);
    const std::int64_t way = product<16>(velocity_, ahead) + product<17>(change, ahead);
    return {position_ + MasterPosition::fine(way), (velocity_ + change) >> MotionPoint::tick_bits, acceleration_};
  }

 private:
  static constexpr std::int64_t rounded(std::int64_t x, int shift) {
    return (x + (std::int64_t{1} << (shift - 1))) >> shift;
  }

  Config config_;
  MasterPosition position_{};
  std::int64_t velocity_ = 0;      // 2^-64 cycles a tick
  std::int64_t acceleration_ = 0;  // the same a tick
};

}  // namespace stiction
