// Motions of one axis as someone who commissions it records them: constant speeds both ways, one axis of a circle,
// small reversals. Each begins at rest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/move_sequence.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::sim {

struct Trajectory {
  std::string name;
  double duration = 0.0;                   // s
  std::function<AxisSetPoint(double)> at;  // rest at t = 0
};

inline constexpr Dynamics standard_start{2.0, 40.0};  // of the source's circle (Tab 6.2)

// Jerk-limited moves there and back at each speed (m/s), `cruise` (s) long at least and at least `shortest` m.
// `speeds`: above 0, in the order of the moves; `dynamics`: of the starts.
Trajectory constant_speeds(const std::vector<double>& speeds, double cruise, double shortest,
                           const Dynamics& dynamics = standard_start);
// X of a circle of `settings` for so many `turns`, begun with its jerk-limited start.
Trajectory circle(const CircleSettings& settings, double turns);
// The same with radius and start of the source, at `feed` (m/s).
Trajectory circle(double feed, double turns);
// A cosine of two periods at each amplitude (m), half of the stroke, at `frequency` (Hz).
Trajectory small_reversals(const std::vector<double>& amplitudes, double frequency);

}  // namespace stiction::sim
