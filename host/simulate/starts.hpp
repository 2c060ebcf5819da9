// How fast motions of experiments begin on an axis, and which speeds its supervision lets pass.
#pragma once

#include <cmath>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/commissioning_path.hpp"

namespace stiction::host {

inline constexpr double acceleration_share = 0.9;  // of what the axis can do at most

// The source's start of a motion (Mendricky 2006, Tab 6.2) as far as the axis can; of a rotary axis, whose scale the
// source does not know, a share of what the axis can.
inline sim::Dynamics start_on(const machine::AxisModel& axis) {
  const auto start = sim::standard_start;
  const double highest = acceleration_share * axis.max_acceleration;
  if (!axis.coordinate.rotary() && start.acceleration <= highest) return start;
  return {highest, start.jerk * highest / start.acceleration};
}

// Highest speed (m/s) at which the cascade stays within its following error: without feedforward it lags by speed over
// gain. Infinite for other controllers, which no fault stops.
inline double highest_followed_speed(const machine::AxisModel& axis) {
  const double missing = 1.0 - axis.feedforward.velocity;
  if (!axis.cascaded() || !axis.supervision.following_error || !(missing > 0.0)) return HUGE_VAL;
  return *axis.supervision.following_error * axis.position_controller.gain / missing;
}

}  // namespace stiction::host
