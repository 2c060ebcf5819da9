#include "firmware/stictiond/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/move_sequence.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::drive {

Motion Motion::circle(const machine::Machine& machine, double feed) {
  sim::CircleSettings settings;
  settings.feed = feed;
  if (machine.axes.size() != 2)
    throw MotionError(fmt::format("circle: found a machine with {} axes; expected 2", machine.axes.size()));
  for (const auto& axis : machine.axes) {
    const double fastest = std::min(axis.max_velocity, std::sqrt(axis.max_acceleration * settings.radius));
    if (!(feed > 0.0) || feed > fastest)
      throw MotionError(
          fmt::format("circle: found a feed of {:g} m/min; expected above 0 and at most {:.4g} m/min, the limit of "
                      "axis {} at R = {:g} mm",
                      feed * 60.0, fastest * 60.0, axis.name, settings.radius * 1e3));
  }
  const sim::CirclePath path(settings);
  const double delay = machine::set_point_delay(machine);
  // In the loop's own clock, whole nanoseconds: a product of doubles would be another one at some ticks.
  const std::int64_t period_ns = machine::fast_period_ns(machine.timing);
  Motion motion(machine.axes.size());
  for (const auto& axis : path.at(0.0).axes) motion.start_.push_back(axis.position);
  for (std::int64_t now_ns = 0;; now_ns += period_ns) {
    const double t = static_cast<double>(now_ns) * 1e-9;
    const auto followed = path.at(std::max(0.0, t - delay));
    if (followed.turned >= sim::CirclePath::lap_end) break;
    for (const auto& axis : delay > 0.0 ? path.at(t).axes : followed.axes)
      motion.sets_.push_back(sim::to_set_point<FixedSignals>(axis));
  }
  return motion;
}

Motion Motion::approach(const machine::Machine& machine, std::span<const double> positions) const {
  constexpr double near = 1e-6;   // m: the first tick of the motion takes that up unnoticed
  constexpr double speed = 0.02;  // m/s
  constexpr sim::Dynamics gentle{0.5, 5.0};
  constexpr double rest = 0.1;  // s, for the axes to swing in

  std::vector<sim::MoveSequence> moves;
  double duration = 0.0;
  for (std::size_t i = 0; i < axes_; ++i) {
    auto& move = moves.emplace_back(positions[i]);
    const double distance = start_[i] - positions[i];
    if (std::abs(distance) < near) continue;
    move.move(distance, speed, gentle);
    duration = std::max(duration, move.duration() + rest);
  }
  Motion motion(axes_);
  const auto ratio = static_cast<std::size_t>(machine::slow_ratio(machine.timing));
  const auto slow_periods = static_cast<std::size_t>(std::ceil(duration / machine.timing.slow_period));
  for (std::size_t tick = 0; tick < slow_periods * ratio; ++tick)
    for (const auto& move : moves)
      motion.sets_.push_back(
          sim::to_set_point<FixedSignals>(move.at(static_cast<double>(tick) * machine.timing.fast_period)));
  return motion;
}

}  // namespace stiction::drive
