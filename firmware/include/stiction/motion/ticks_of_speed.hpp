// A way as a speed: the one that makes it in a tick. Ways and speeds of profiles are compared so, in whole numbers.
#pragma once

#include <cstdint>

#include "stiction/number/fixed_signals.hpp"

namespace stiction {

// `way`: 2^-40 m, below 128 m; `rate`: 1 / tick. Returns 2^-28 m/s, exact to one unit.
constexpr std::uint64_t ticks_of_speed(std::uint64_t way, FixedSignals::Rate rate) {
  const auto per_second = static_cast<std::uint64_t>(rate.raw());
  const std::uint64_t upper = way >> 20, lower = way & 0xfffff;
  return (upper * per_second + ((lower * per_second) >> 20)) >> 2;
}

}  // namespace stiction
