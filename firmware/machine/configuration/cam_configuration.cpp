#include "firmware/machine/configuration/cam_configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stiction::machine {
namespace {

// A derivative of this order is in 2^-(40 + 12 order) units a tick to that power.
int bits_of(int order) { return MotionPoint::position_bits + MotionPoint::tick_bits * order; }

std::int64_t raw(double bound, double period, int order) {
  constexpr double most = 0x1p56;  // motion_point.hpp
  const double scaled = std::ldexp(bound * std::pow(period, order), bits_of(order));
  return std::max<std::int64_t>(1, std::llround(std::min(scaled, most)));
}
double bound(std::int64_t raw, double period, int order) {
  return std::ldexp(static_cast<double>(raw), -bits_of(order)) / std::pow(period, order);
}

}  // namespace

MotionLimits motion_limits(const MotionBounds& bounds, double period) {
  return {raw(bounds.velocity, period, 1), raw(bounds.acceleration, period, 2), raw(bounds.jerk, period, 3)};
}

MotionBounds motion_bounds(const MotionLimits& limits, double period) {
  return {bound(limits.velocity, period, 1), bound(limits.acceleration, period, 2), bound(limits.jerk, period, 3)};
}

// SpeedRampRule takes 9/4 v / a and at least 7 a / j for a change of speed by v; a cycle at the mean speed is 2 / v.
// With a fiftieth more the ramp is over before the cycle is.
MotionBounds master_bounds(double speed) { return {speed, 1.15 * speed * speed, 4.2 * speed * speed * speed}; }

MotionBounds cam_bounds(const Timing& timing, const AxisModel& axis) {
  return {axis.max_velocity, axis.max_acceleration, axis.max_acceleration / timing.slow_period};
}

std::int64_t master_speed(double speed, double period) {
  // The bound as its limit has it, so that the largest speed is within it.
  const std::int64_t scaled = std::llround(std::ldexp(speed * period, bits_of(1)));
  return scaled * (std::int64_t{1} << MotionPoint::tick_bits);
}

std::string words_of_limits(const CamCurve& curve, const CamMotion::Config& config, double period, double factor,
                            const std::string& unit) {
  const auto needed = motion_bounds(curve.motion(config.master_sum), period);
  const auto most = motion_bounds(config.slave, period);
  const auto text = [&](const MotionBounds& b) {
    return fmt::format("{:.4g} {}/s, {:.4g} {}/s^2 and {:.4g} {}/s^3", b.velocity * factor, unit,
                       b.acceleration * factor, unit, b.jerk * factor, unit);
  };
  return fmt::format(
      "found a curve that takes up to {} at the largest speed of the master and while it gets there; "
      "expected at most {}, the limits of the axis",
      text(needed), text(most));
}

}  // namespace stiction::machine
