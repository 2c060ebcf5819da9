// The lift that leaves the least vibration over a band of frequencies: a linear programme in the acceleration at the
// nodes of a polygon, within limits of speed, acceleration and jerk of the unit law. Solved by Clp; whoever uses a lift
// simulates it again.
#pragma once

#include <optional>
#include <vector>

#include "sim/cam/shaping/task.hpp"

namespace stiction::sim::cam {

// For a `task`, with its limits, over its band: the load's distance from where it rests, as the transfer function has
// it, in the first period of the dwell. None where no lift keeps the limits.
struct OptimalLift {
  Curve lift;
  double bound = 0.0;  // peak to peak, of the programme
};
std::optional<OptimalLift> band_optimal_lift(const ShapingTask& task);

// The least peak to peak over the band, over the stroke, of a load on a base that moves by any lift within `limits`:
// `periods` of the load's mode with that `damping_ratio` in the rise, frequencies from 1 - band to 1 + band. The
// drive's own lag is left out, so that the figure holds for any drive. None where no lift keeps the limits.
std::optional<double> least_residual(double periods, double damping_ratio, double band, const LiftLimits& limits);

struct FrontierPoint {
  double periods = 0.0;
  double residual = 0.0;  // over the stroke
};

// That least residual over the length of the rise, from `from` to `to` periods in `count` points; lengths at which no
// lift keeps the limits are left out. `damping_ratio`, `band`, `limits` as above.
std::vector<FrontierPoint> frontier(double from, double to, int count, double damping_ratio, double band,
                                    const LiftLimits& limits);

// The shortest rise, in periods, that leaves at most `residual` of the stroke; none up to 8 periods. `damping_ratio`,
// `band`, `limits` as above.
std::optional<double> shortest_rise(double residual, double damping_ratio, double band, const LiftLimits& limits);

}  // namespace stiction::sim::cam
