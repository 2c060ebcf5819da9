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
    const std::int64_t square = product_shifted(master.velocity, master.velocity, 40);
    const std::int64_t cube = product_shifted(square, master.velocity, 40);
    const std::int64_t mixed = product_shifted(master.velocity, master.acceleration, 40);
    MotionLimits needed;
    needed.velocity = product_shifted(slope, master.velocity, 40);
    needed.acceleration = sum(product_shifted(bend, square, 40), product_shifted(slope, master.acceleration, 40), 0);
    needed.jerk = sum(product_shifted(third, cube, 40), product_shifted(bend, 3 * mixed, 40),
                      product_shifted(slope, master.jerk, 40));
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
