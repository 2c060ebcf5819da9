// The friction compensation of a whole machine: each axis tuned after the other, then compared on circles.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/tune/tuning_result.hpp"

namespace stiction::host {

// The circles of a tuning, unless feeds are given: those of the measurements on the cross table. Where an axis cannot
// drive the fastest of them, all are slower by one factor and smaller.
struct TuningCircles {
  double radius = 0.09;                                                                      // m
  std::vector<double> feeds{3.2 / 60.0, 8.0 / 60.0, 16.0 / 60.0, 24.0 / 60.0, 48.0 / 60.0};  // m/s, before and after
  double shown = 16.0 / 60.0;                                                                // of the charts
  double timing = 0.4;  // of the laps for the timing rule
  std::vector<double> without_logs{3.2 / 60.0, 16.0 / 60.0, 48.0 / 60.0};
};
TuningCircles tuning_circles(const machine::Machine& machine);

struct MachineTuningSettings {
  std::vector<std::size_t> axes;  // to tune, by index
  std::vector<double> feeds;      // m/s, of the comparison; empty: those of tuning_circles
  std::optional<double> shown;    // m/s, of the charts and of the pulse; none: that of tuning_circles
  bool pulse = true;              // whether the speed pulse is tuned, which takes 500 simulated laps an axis
  std::function<void(std::size_t circles)> begin_comparison = {};  // told how many circles follow
  std::function<void(const std::string& axis)> tuned = {};         // after each axis
  std::function<void()> compared = {};                             // after each circle
};

// Tunes `machine` from `logs`, or from circles of its own simulation where there are none. `settings`: axes and feeds.
// Throws LogError, InfeasibleMotion, FaultTripped.
TunedCompensations tune_machine(const machine::Machine& machine, const std::vector<Log>& logs,
                                const MachineTuningSettings& settings);

}  // namespace stiction::host
