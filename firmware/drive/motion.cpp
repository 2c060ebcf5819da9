#include "firmware/drive/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/control/axis_configuration.hpp"
#include "sim/control/compensation_configuration.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/set_point.hpp"

namespace stiction::drive {

Motion Motion::circle(const sim::Machine& machine, double feed) {
  sim::CircleSettings settings;
  settings.feed = feed;
  if (machine.axes.size() != 2)
    throw MotionError(fmt::format("circle: found a machine with {} axes; expected 2", machine.axes.size()));
  for (const auto& axis : machine.axes) {
    const double fastest = std::min(axis.max_velocity, std::sqrt(axis.max_acceleration * settings.radius));
    if (!(feed > 0.0) || feed > fastest)
      throw MotionError(
          fmt::format("circle: found a feed of {:g} m/min; expected above 0 and at most {:.4g} m/min, "
                      "what axis {} can do at R = {:g} mm",
                      feed * 60.0, fastest * 60.0, axis.name, settings.radius * 1e3));
  }
  const sim::CirclePath path(settings);
  const double delay = sim::set_point_delay(machine);
  // In the loop's own clock, whole nanoseconds: a product of doubles would be another one at some ticks.
  const std::int64_t period_ns = sim::fast_period_ns(machine.timing);
  Motion motion(machine.axes.size());
  for (std::int64_t now_ns = 0;; now_ns += period_ns) {
    const double t = static_cast<double>(now_ns) * 1e-9;
    const auto followed = path.at(std::max(0.0, t - delay));
    if (followed.turned >= sim::CirclePath::lap_end) break;
    for (const auto& axis : delay > 0.0 ? path.at(t).axes : followed.axes)
      motion.sets_.push_back(sim::to_set_point<FixedSignals>(axis));
  }
  return motion;
}

Motion Motion::hold(const sim::Machine& machine, std::span<const double> positions, double duration) {
  Motion motion(machine.axes.size());
  const auto ticks = static_cast<std::size_t>(std::ceil(duration / machine.timing.fast_period));
  for (std::size_t i = 0; i < ticks; ++i)
    for (const double position : positions)
      motion.sets_.push_back(sim::to_set_point<FixedSignals>({.position = position}));
  return motion;
}

}  // namespace stiction::drive
