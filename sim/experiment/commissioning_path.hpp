// Motions of one axis as someone who commissions it records them: constant speeds both ways, one axis of a circle,
// small reversals. Each begins at rest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/experiment/set_point.hpp"

namespace stiction::sim {

struct Trajectory {
  std::string name;
  double duration = 0.0;                   // s
  std::function<AxisSetPoint(double)> at;  // rest at t = 0
};

// Jerk-limited moves there and back at each speed (m/s), `cruise` (s) long at least and at least `shortest` m.
// `speeds`: above 0, in the order of the moves.
Trajectory constant_speeds(const std::vector<double>& speeds, double cruise, double shortest);
// X of a circle of radius 90 mm at the feed (m/s), begun with the standard jerk-limited start.
Trajectory circle(double feed, double turns);
// A cosine of two periods at each amplitude (m), half of the stroke, at `frequency` (Hz).
Trajectory small_reversals(const std::vector<double>& amplitudes, double frequency);

}  // namespace stiction::sim
