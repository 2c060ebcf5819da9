// How much a curve asks of its slave: bounds of its first three derivatives over the master, and what they are as
// speed, acceleration and jerk behind a master with limits of its own.
#pragma once

#include <cstdint>

#include "stiction/motion/motion_point.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

// Bounds of the first three derivatives over the master, 2^-40 of the slave's unit.
struct CamPeaks {
  std::int64_t slope = 0, bend = 0, third = 0;

  // What a slave needs to follow a curve with these peaks behind a master that keeps `master`.
  constexpr MotionLimits motion(const MotionLimits& master) const {
    const std::int64_t square = product<40>(master.velocity, master.velocity);
    const std::int64_t cube = product<40>(square, master.velocity);
    const std::int64_t mixed = product<40>(master.velocity, master.acceleration);
    MotionLimits needed;
    needed.velocity = product<40>(slope, master.velocity);
    needed.acceleration = held(product<40>(bend, square)) + held(product<40>(slope, master.acceleration));
    needed.jerk =
        held(product<40>(third, cube)) + 3 * held(product<40>(bend, mixed)) + held(product<40>(slope, master.jerk));
    return needed;
  }

 private:
  // So that five of them are within a word, and beyond all limits.
  static constexpr std::int64_t held(std::int64_t x) {
    constexpr std::int64_t most = INT64_MAX / 8;
    return x < most ? x : most;
  }
};

}  // namespace stiction
