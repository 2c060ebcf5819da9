// A motion at one tick, in units of the tick: what masters, cams, gears and the bridges between them exchange. No
// period of the tick enters their laws, so that nothing of them is rounded by it. A unit is m or rad of a slave, a
// cycle of a master.
#pragma once

#include <cstdint>

#include "stiction/number/product.hpp"

namespace stiction {

struct MotionPoint {
  static constexpr int position_bits = 40;      // 2^-40 units
  static constexpr int velocity_bits = 52;      // 2^-52 units a tick
  static constexpr int acceleration_bits = 64;  // 2^-64 units a tick, a tick
  static constexpr int tick_bits = 12;          // from each of them to the next; jerk is in 2^-76

  std::int64_t position = 0;
  std::int64_t velocity = 0;
  std::int64_t acceleration = 0;

  friend constexpr bool operator==(const MotionPoint&, const MotionPoint&) = default;
  // One motion on top of the other: a second cam, or a move, superposed.
  friend constexpr MotionPoint operator+(const MotionPoint& a, const MotionPoint& b) {
    return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
  }
  friend constexpr MotionPoint operator-(const MotionPoint& a, const MotionPoint& b) {
    return {a.position - b.position, a.velocity - b.velocity, a.acceleration - b.acceleration};
  }
};

// Magnitudes that a motion keeps, in the formats of a MotionPoint; up to 2^56 each, from which on sums of bridges are
// beyond a word (8 units/s and 10^6 units/s^2 are 2^41 and 2^56 at 16 kHz).
struct MotionLimits {
  std::int64_t velocity = 0;
  std::int64_t acceleration = 0;
  std::int64_t jerk = 0;  // 2^-76 units a tick, a tick, a tick

  friend constexpr bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

}  // namespace stiction
