// The whole friction compensation of an axis: the friction feedforward from logs, its look-ahead by the timing rule on
// laps driven with it, the bounds of the learning from the friction found; and the industry's speed pulse beside it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host/tune/friction_tuning.hpp"
#include "host/tune/pulse_tuning.hpp"
#include "host/tune/timing_rule.hpp"
#include "sim/experiment/circle_path.hpp"

namespace stiction::host {

struct CompensationSettings {
  TuningSettings friction;
  double set_point_delay = 10.0;             // ticks by which all axes follow late, at least
  std::optional<sim::CircleSettings> pulse;  // the circle at which the speed pulse is tuned; none: no pulse
};

// A lap with the compensation that the machine holds: of the real machine, or of a simulation of it.
using DriveLap = std::function<Log(const machine::Machine&)>;

struct JudgedLap {
  double look_ahead = 0.0;  // s, with which it was driven
  TimingError timing;
};

struct CompensationTuning {
  FrictionTuning friction;
  std::vector<JudgedLap> laps;  // by the timing rule
  std::optional<PulseTuning> pulse;
  machine::Machine machine;  // with the compensation on the axis, learning in use
};

// `logs`: of the machine's axis without compensation (friction_tuning.hpp). Throws LogError. `machine`: with the index
// `axis` to tune; `drive_lap`: drives a lap with a compensation; `settings`: look-ahead and pulse.
CompensationTuning tune_compensation(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                                     const DriveLap& drive_lap, const CompensationSettings& settings = {});

// A circle of one axis in simulation, as a log of `laps` laps at the drive's rate. `machine`: with the index `axis`
// that moves; `circle`: radius, feed and direction.
Log simulated_circle(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle, int laps);

}  // namespace stiction::host
