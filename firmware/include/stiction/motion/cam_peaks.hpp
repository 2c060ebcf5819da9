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
    needed.acceleration = sum(product<40>(bend, square), product<40>(slope, master.acceleration), 0);
    needed.jerk = sum(product<40>(third, cube), product<40>(bend, 3 * mixed), product<40>(slope, master.jerk));
    return needed;
  }

 private:
  static constexpr std::int64_t sum(std::int64_t a, std::int64_t b, std::int64_t c) {
    constexpr std::int64_t most = INT64_MAX / 4;
    const auto held = [](std::int64_t x) { return x < most ? x : most; };
    return held(a) + held(b) + held(c);
  }
};

}  // namespace stiction
