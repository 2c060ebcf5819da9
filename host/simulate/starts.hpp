// How fast motions of experiments begin on an axis.
#pragma once

#include <algorithm>

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

}  // namespace stiction::host
