// The methods against residual vibration side by side on one axis: what each leaves over a band of frequencies, what it
// asks of the axis, and what no lift can do better.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/cam/axis_load.hpp"
#include "sim/cam/shaping/band_optimal.hpp"
#include "sim/cam/shaping/methods.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct ShapedRow {
  const sim::cam::ShapingMethod* method = nullptr;
  std::optional<sim::cam::ShapedMotion> made;  // none: it has no room
  double torque = 0.0;                         // of the motor at the axis, peak: N m or N
  std::string broken{};                        // the limit of the axis that it breaks, a sentence; empty: none
};

struct ShapingResult {
  sim::cam::ShapingTask task;
  std::vector<ShapedRow> rows;
  std::vector<sim::cam::FrontierPoint> frontier;
  double wanted = 0.0;                     // peak to peak, of the slave
  std::optional<double> least;             // what no lift within the limits betters, of the slave
  std::optional<double> shortest_periods;  // the shortest rise that leaves what is wanted
  std::string verdict;                     // a sentence
};

// What a lift of `stroke` in `rise_time` (s) may ask of an axis with that `load`, as figures of the unit law: its
// speed, acceleration and torque, and at most the acceleration and jerk of LiftLimits.
sim::cam::LiftLimits limits_of(const AxisLoad& load, double stroke, double rise_time);

// The `methods` on a `task`, for an axis with that `load`. `wanted`: what may be left from peak to peak.
ShapingResult shape(const sim::cam::ShapingTask& task, const AxisLoad& load,
                    const std::vector<const sim::cam::ShapingMethod*>& methods, double wanted);

// Figures, charts and sentences of it.
sim::ExperimentResult shaping_report(const ShapingResult& result);

}  // namespace stiction::host
