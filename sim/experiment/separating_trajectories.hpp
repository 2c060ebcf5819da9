// Motions of one axis that tell causes apart: each makes some effects show that others cannot imitate. One row of the
// table a motion; which one serves is for the caller to compute.
#pragma once

#include <span>

#include "sim/experiment/commissioning_path.hpp"

namespace stiction::sim {

// What a motion may use of the axis.
struct MotionRange {
  double low, high;             // m, positions
  double speed;                 // m/s
  double acceleration;          // m/s^2
  double jerk;                  // m/s^3
  double highest_acceleration;  // m/s^2, where accelerations are what is looked at; jerk in proportion
};

struct SeparatingTrajectory {
  const char* name;
  const char* words;  // what it does and what that shows
  // From rest at `low`. What does not fit into the range is made smaller.
  Trajectory (*make)(const MotionRange&);
};

std::span<const SeparatingTrajectory> separating_trajectories();

}  // namespace stiction::sim
