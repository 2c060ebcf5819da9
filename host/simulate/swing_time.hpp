// How long what an axis did before a record still shows in it.
#pragma once

#include <algorithm>
#include <cmath>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

inline constexpr double longest_swing = 10.0;  // s, of a swing that hardly decays

// s, in which a swing of the load behind an elastic shaft of the `axis` falls to a thousandth where the motor stands;
// 0: the axis has no such shaft.
inline double swing_time(const machine::AxisModel& axis) {
  if (!axis.elastic()) return 0.0;
  const double damping = axis.transmission->damping.value_or(0.0), load = axis.mass - axis.motor_mass;
  return damping > 0.0 ? std::min(std::log(1e3) * 2.0 * load / damping, longest_swing) : longest_swing;
}

}  // namespace stiction::host
