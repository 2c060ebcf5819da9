// A motion in units of the tick (motion_point.hpp) as the set-point of an axis, in integers: the same bits in the drive
// and in the simulation.
#pragma once

#include <cstdint>

#include "stiction/drive/exchange.hpp"
#include "stiction/motion/motion_point.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "stiction/number/product.hpp"

namespace stiction {

// `point`: in m; `rate`: ticks a second. Not valid where speed or acceleration are beyond the formats.
constexpr SetPoint<FixedSignals> cam_set_point(const MotionPoint& point, FixedSignals::Rate rate) {
  using S = FixedSignals;
  constexpr int velocity_shift = MotionPoint::velocity_bits + S::Rate::fraction_bits - S::Velocity::fraction_bits;
  constexpr int acceleration_shift =
      MotionPoint::acceleration_bits + 2 * S::Rate::fraction_bits - S::Acceleration::fraction_bits;
  constexpr std::int64_t most_position = std::int64_t{1} << 60;
  const std::int64_t per_second = rate.raw();
  const std::int64_t v = product_shifted(point.velocity, per_second, velocity_shift);
  const std::int64_t a = product_shifted(point.acceleration, per_second * per_second, acceleration_shift);
  const auto within = [](std::int64_t x) { return x >= -INT32_MAX && x <= INT32_MAX; };
  const auto word = [&](std::int64_t x) { return within(x) ? static_cast<std::int32_t>(x) : 0; };
  SetPoint<S> set{};
  set.valid = within(v) && within(a) && magnitude(point.position) < static_cast<std::uint64_t>(most_position);
  set.position = S::Position::from_raw(set.valid ? point.position : 0);
  set.velocity = S::Velocity::from_raw(word(v));
  set.acceleration = S::Acceleration::from_raw(word(a));
  return set;
}

}  // namespace stiction
