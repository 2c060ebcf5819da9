#include "host/tune/compensation_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host/simulate/log_recorder.hpp"
#include "host/simulate/quadrant_run.hpp"

namespace stiction::host {
namespace {

constexpr int most_laps = 2;              // that are judged by the timing rule
constexpr double learning_share = 0.5;    // of the Coulomb current: what learning may add at most
constexpr double least_presliding = 0.1;  // of the current without the mass' part; below it, that current counts

machine::QuadrantLearningParameters learning_for(const FrictionTuning& friction) {
  machine::QuadrantLearningParameters learning{0.6, 0.02, 0.2, 0.0, 0.3e-6, 1e-3, {}};
  const bool sliding_only = friction.coulomb < least_presliding * friction.current_rms;
  learning.limit = learning_share * (sliding_only ? friction.current_rms : friction.coulomb);
  return learning;
}

}  // namespace

CompensationTuning tune_compensation(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                                     const DriveLap& drive_lap, const CompensationSettings& settings) {
  CompensationTuning tuning{tune_friction(logs, machine.axes[axis], settings.friction), {}, {}, machine};
  auto& timing = tuning.machine.timing;
  timing.set_point_delay = std::max(timing.set_point_delay, settings.set_point_delay * timing.fast_period);
  auto& compensation = tuning.machine.axes[axis].friction_compensation.emplace();
  compensation.use = CompensationKind::friction;
  compensation.friction = tuning.friction.friction;
  auto& ahead = compensation.friction->look_ahead;
  ahead = expected_look_ahead(timing, machine.axes[axis]);
  for (int lap = 0; lap < most_laps; ++lap) {
    tuning.laps.push_back({ahead, timing_of(drive_lap(tuning.machine), tuning.machine, axis)});
    const auto& judged = tuning.laps.back().timing;
    if (judged.verdict(timing.fast_period) == "in time") break;
    ahead = std::clamp(ahead + judged.late, 0.0, timing.set_point_delay);
  }
  tuning.friction.friction.look_ahead = ahead;
  compensation.learning = learning_for(tuning.friction);
  if (settings.pulse) {
    tuning.pulse = tune_pulse(tuning.machine, axis, *settings.pulse);
    compensation.pulse = tuning.pulse->pulse;
  }
  compensation.use = CompensationKind::learning;
  return tuning;
}

Log simulated_circle(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& circle, int laps) {
  LogRecorder recorder(one_axis(machine, axis));
  run_quadrants(machine, axis, circle, laps, recorder.sink<FixedSignals>());
  auto log = recorder.take();
  log.source = fmt::format("simulated circle at {:g} m/min", 60.0 * circle.feed);
  return log;
}

}  // namespace stiction::host
