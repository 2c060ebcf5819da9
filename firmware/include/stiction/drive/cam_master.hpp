// The master of the axes of a drive in a tick: a virtual one, or the position of an axis or of an encoder through the
// estimator. Taken before its slaves in each tick, so that all of them see the same place.
#pragma once

#include <cstdint>

#include "stiction/motion/master.hpp"
#include "stiction/motion/master_estimator.hpp"

namespace stiction {

// What a master shows in a tick.
struct MasterReading {
  MasterPoint point{};
  bool valid = true;
};

class CamMaster {
 public:
  struct Config {
    bool measured = false;
    VirtualMaster::Config virtual_master{};
    MasterEstimator::Config estimator{};  // of a measured one
    Span cycle{};                         // of a measured one, in units of what see() gets
  };

  explicit constexpr CamMaster(const Config& config)
      : config_(config), virtual_(config.virtual_master), estimator_(config.estimator) {}

  // Goes to `speed`, 2^-64 cycles a tick, held to its limit. False, and nothing changes, where the master is measured.
  constexpr bool run(std::int64_t speed) {
    const std::int64_t most = config_.virtual_master.limits.velocity << MotionPoint::tick_bits;
    if (config_.measured) return false;
    return virtual_.run(speed > most ? most : speed < -most ? -most : speed);
  }

  // The virtual master of the coming tick.
  constexpr const MasterReading& step() { return reading_ = {virtual_.step(), true}; }
  // A measured one at `position`; one that is not `valid` has to be known for a while before it counts again.
  constexpr const MasterReading& see(std::int64_t position, bool valid) {
    const std::int64_t length = config_.cycle.length;
    std::int64_t cycles = position / length, rest = position % length;
    if (rest < 0) {
      --cycles;
      rest += length;
    }
    return see(cycles, rest, valid);
  }
  // The same `rest` behind the begin of a cycle, one of `cycles`; `rest`: 0 to the length of a cycle; `valid`: as
  // above.
  constexpr const MasterReading& see(std::int64_t cycles, std::int64_t rest, bool valid) {
    if (!valid) {
      known_ = 0;
      reading_.valid = false;
      return reading_;
    }
    constexpr int bits = 60;  // so that a whole cycle stays within a word
    const MasterPosition at{cycles, static_cast<std::uint64_t>(config_.cycle.divide(rest, bits)) << (64 - bits)};
    // From the second on its speed is known too: one that turns when it is found.
    if (known_ == 0) estimator_.start(at);
    if (known_ == 1) estimator_.start(first_, static_cast<std::int64_t>((at - first_).phase));
    if (known_ == 0) first_ = at;
    const bool follows = estimator_.step(at);
    const std::int32_t settled = std::int32_t{16} << config_.estimator.bits;
    known_ = known_ < settled ? known_ + 1 : settled;
    // A jump is seen by the slave, from the place that it led to.
    if (!follows) estimator_.start(at);
    return reading_ = {estimator_.point(), known_ == settled};
  }

  constexpr const MasterReading& reading() const { return reading_; }
  // Whether a virtual one is at standstill.
  constexpr bool at_rest() const { return virtual_.at_speed() && virtual_.point().velocity == 0; }

 private:
  Config config_;
  VirtualMaster virtual_;
  MasterEstimator estimator_;
  MasterReading reading_{};
  MasterPosition first_{};  // seen
  std::int32_t known_ = 0;  // ticks in a row
};

}  // namespace stiction
