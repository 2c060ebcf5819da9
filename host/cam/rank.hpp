// Every law for one stroke: what it asks of the axis, and what oscillation it leaves. The Pareto front of peak speed,
// acceleration, motor torque and residual oscillation, and one recommendation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/cam/axis_load.hpp"
#include "host/cam/duty.hpp"
#include "sim/cam/laws.hpp"

namespace stiction::host {

struct RankTask {
  double stroke = 0.0;                 // of the slave
  double rise = 0.0;                   // of the master, above 0
  double master_speed = 0.0;           // above 0
  double lowest = 0.0, highest = 0.0;  // Hz, the band of natural frequencies
  std::string task = "R-R";            // of VDI 2143, or every_task
};

// Compares the laws of all tasks and the rise-return ones, whose way back takes as long as the rise.
inline constexpr std::string_view every_task = "all";

struct RankedLaw {
  const sim::cam::Law* law = nullptr;
  double speed = 0.0, acceleration = 0.0, jerk = 0.0;  // peaks over time
  double effort = 0.0;                                 // of the motor
  double residual = 0.0;                               // largest amplitude over the band, of the slave, undamped
  bool jumps = false;                                  // of the acceleration
  bool broken = false;                                 // a limit of the axis
  bool front = false;                                  // no law is better in all four figures
};

struct Ranking {
  std::vector<RankedLaw> laws;               // by residual, then torque
  std::optional<std::size_t> recommended{};  // of laws; none where every law jumps or breaks a limit
  std::string reason;                        // a sentence
};

// The natural frequencies that matter for a load: 20 % around that of an elastic axis, else 1 to 5 periods in the rise.
// `load`: of the axis; `rise_time` in s.
struct FrequencyBand {
  double lowest, highest;
};
FrequencyBand usual_band(const AxisLoad& load, double rise_time);

// Ranks all laws of a `task` on an axis with that `load`. Of every task, one from rest to rest is recommended: a stroke
// by itself begins and ends at rest. A law may ask for at most this share more torque than the least of those without a
// jump to be recommended.
inline constexpr double effort_margin = 0.25;
Ranking rank_laws(const RankTask& task, const AxisLoad& load);

}  // namespace stiction::host
