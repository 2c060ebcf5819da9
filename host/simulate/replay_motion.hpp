// The set-points of a replay: those of a log, with the way to its first one.
#pragma once

#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/log/repeating_motion.hpp"
#include "host/log/set_points.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::host {

inline constexpr double longest_lead_in = 0.5;  // s

class ReplayMotion {
 public:
  // Of the axis with these `channels` of a linear `log`; `axis`: of the machine that goes this way. Throws LogError for
  // a log without set-points, and for one that is faster than an axis with the cascade may be.
  ReplayMotion(const Log& log, const AxisLog& channels, const machine::AxisModel& axis);

  double lead_in() const { return begin_ - start_ + length_; }  // s

  // At t s on the log's clock; before the lead-in the axis rests at its beginning.
  sim::AxisSetPoint at(double t) const;

  const SetPoints& points() const { return points_; }

 private:
  sim::AxisSetPoint repeated(double t) const;
  double rest() const;

  SetPoints points_;
  std::optional<RepeatingMotion> repeats_;
  double begin_, start_;  // s; of the log, and of the cycles that are gone through before it
  double v_ = 0.0, a_ = 0.0, x_ = 0.0;
  bool moving_ = false, uniform_ = false;
  double length_ = 0.0;
};

// N, or another channel's unit: `values` of the `log`, linear between its samples, at t s; 0 outside them.
double at_time(const Log& log, const std::vector<double>& values, double t);

// s, on the log's clock: the tick from which a replay with this `lead_in` (s) runs, whole slow periods of the `machine`
// before the `log`.
double replay_zero(const machine::Machine& machine, const Log& log, double lead_in);

// Gives the replayed `channels` the set-points that were followed, and the zero of the encoder that recorded them;
// `recorded`: by the `axis`, along `motion`.
void finish_replay(AxisLog& channels, const AxisLog& recorded, const machine::AxisModel& axis,
                   const ReplayMotion& motion);

}  // namespace stiction::host
