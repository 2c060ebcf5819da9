// Where a master is, in whole cycles and 2^-64 of one. A cycle is a revolution of a line shaft, or the length after
// which a cam repeats; its fraction wraps by nature, so that nothing drifts, and a master that has gone 10^9 cycles is
// as exactly known as at its first.
#pragma once

#include <cstdint>

#include "stiction/motion/motion_point.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

struct MasterPosition {
  std::int64_t cycles = 0;  // towards minus infinity
  std::uint64_t phase = 0;  // 2^-64 cycles

  friend constexpr bool operator==(const MasterPosition&, const MasterPosition&) = default;

  // Of the rest of a cycle alone, in 2^-32.
  constexpr std::uint32_t coarse() const { return static_cast<std::uint32_t>(phase >> 32); }

  friend constexpr MasterPosition operator+(const MasterPosition& a, const MasterPosition& b) {
    const std::uint64_t rest = a.phase + b.phase;
    return {wrapped(a.cycles, b.cycles, rest < a.phase ? 1 : 0), rest};
  }
  friend constexpr MasterPosition operator-(const MasterPosition& a) {
    const std::uint64_t rest = std::uint64_t{0} - a.phase;
    return {wrapped(0, static_cast<std::int64_t>(~static_cast<std::uint64_t>(a.cycles)), rest == 0 ? 1 : 0), rest};
  }
  friend constexpr MasterPosition operator-(const MasterPosition& a, const MasterPosition& b) { return a + -b; }

  // A way of `raw` 2^-64 cycles, below half a cycle.
  static constexpr MasterPosition fine(std::int64_t raw) { return {raw < 0 ? -1 : 0, static_cast<std::uint64_t>(raw)}; }
  // A way of `raw` 2^-40 cycles.
  static constexpr MasterPosition way(std::int64_t raw) {
    return {raw >> MotionPoint::position_bits, static_cast<std::uint64_t>(raw) << (64 - MotionPoint::position_bits)};
  }
  // As 2^-40 cycles, rounded down; beyond 2^22 cycles the ends of that.
  constexpr std::int64_t raw() const {
    constexpr std::int64_t most = std::int64_t{1} << 22;
    const std::int64_t bounded = cycles < -most ? -most : cycles >= most ? most - 1 : cycles;
    return bounded * (std::int64_t{1} << MotionPoint::position_bits) +
           static_cast<std::int64_t>(phase >> (64 - MotionPoint::position_bits));
  }

 private:
  static constexpr std::int64_t wrapped(std::int64_t a, std::int64_t b, unsigned carry) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b) + carry);
  }
};

// A master at a tick: where it is, and its speed and acceleration in the formats of a MotionPoint, in cycles.
struct MasterPoint {
  MasterPosition position{};
  std::int64_t velocity = 0;
  std::int64_t acceleration = 0;

  friend constexpr bool operator==(const MasterPoint&, const MasterPoint&) = default;
};

}  // namespace stiction
