#include "host/simulate/circle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/friction_choice.hpp"
#include "sim/experiment/circle_measurement.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double metre_per_minute = 1.0 / 60.0;  // m/s
constexpr double reserve = 0.9;                  // of what an axis can do at most, where nobody says more

constexpr double ticks_of_a_lap = 8.0;  // at least, of the position controller: two for each quadrant

}  // namespace

void check_circle(const machine::AxisModel& axis, const sim::CircleSettings& settings) {
  const double acceleration = settings.feed * settings.feed / settings.radius;
  if (!(settings.feed > 0.0) || settings.feed > axis.max_velocity)
    throw InfeasibleMotion(
        fmt::format("feed: found {:g} m/min; expected above 0 and at most {:g} m/min, the "
                    "max_velocity of axis {}",
                    settings.feed / metre_per_minute, axis.max_velocity / metre_per_minute, axis.name));
  if (acceleration > axis.max_acceleration)
    throw InfeasibleMotion(
        fmt::format("feed: found {:g} m/min, v^2/R = {:.4g} m/s^2 at R = {:g} mm; expected at most "
                    "{:g} m/s^2, the max_acceleration of axis {}: {:.4g} m/min",
                    settings.feed / metre_per_minute, acceleration, settings.radius * 1e3, axis.max_acceleration,
                    axis.name, std::sqrt(axis.max_acceleration * settings.radius) / metre_per_minute));
  if (!(settings.radius > 0.0) || 2.0 * settings.radius > axis.travel)
    throw InfeasibleMotion(
        fmt::format("radius: found {:g} mm; expected above 0 and at most {:g} mm, half the travel "
                    "of axis {}",
                    settings.radius * 1e3, axis.travel * 0.5e3, axis.name));
}

void check_circle(const machine::Machine& machine, const sim::CircleSettings& settings) {
  if (machine.axes.empty() || machine.axes.size() > 2)
    throw InfeasibleMotion(
        fmt::format("circle: found a machine with {} axes; expected one or two", machine.axes.size()));
  for (const auto& axis : machine.axes) check_circle(axis, settings);
  const double lap = 2.0 * std::numbers::pi * settings.radius / settings.feed;
  const double least = ticks_of_a_lap * machine.timing.slow_period;
  if (lap < least)
    throw InfeasibleMotion(
        fmt::format("radius: found {:g} mm, at {:g} m/min a lap of {:.3g} ms; expected a lap of at least {:g} ms, {:g} "
                    "periods of the position controller",
                    settings.radius * 1e3, settings.feed / metre_per_minute, lap * 1e3, least * 1e3, ticks_of_a_lap));
}

double usual_radius(const machine::Machine& machine) {
  double radius = 0.09;
  for (const auto& axis : machine.axes) radius = std::min(radius, 0.5 * reserve * axis.travel);
  return radius;
}

double highest_feed(const machine::Machine& machine, double radius) {
  double allowed = HUGE_VAL;
  for (const auto& axis : machine.axes)
    allowed = std::min({allowed, reserve * axis.max_velocity, std::sqrt(reserve * axis.max_acceleration * radius)});
  return allowed;
}

double usual_feed(const machine::Machine& machine, double radius) {
  const double allowed = highest_feed(machine, radius);
  for (double scale = 1.0; scale > 1e-9; scale *= 0.1)
    for (const double feed : {16.0, 8.0, 3.2})
      if (feed * scale / 60.0 <= allowed) return feed * scale / 60.0;
  return allowed;
}

sim::CircleSettings circle_settings(const machine::Machine& machine, double feed, double radius) {
  sim::CircleSettings settings;
  settings.feed = feed;
  settings.radius = radius;
  for (const auto& axis : machine.axes)
    if (axis.max_acceleration < settings.acceleration) {
      settings.jerk *= axis.max_acceleration / settings.acceleration;
      settings.acceleration = axis.max_acceleration;
    }
  return settings;
}

template <class S>
sim::CircleRun run_circle(const machine::Machine& machine, const sim::CircleSettings& settings,
                          const TraceSink<S>& trace) {
  check_circle(machine, settings);
  const sim::CirclePath path(settings);
  const auto start = path.at(0.0);
  const std::array<double, 2> positions{start.axes[0].position, start.axes[1].position};
  const std::size_t axes = machine.axes.size();
  ControlRun<S> run(machine, std::span(positions).first(axes));
  const bool late = machine::set_point_delay(machine) > 0.0;
  std::vector<std::string> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  sim::CircleMeasurement measurement(settings, machine.timing.fast_period, names);
  for (;;) {
    auto point = path.at(std::max(0.0, run.set_point_time()));
    point.turned -= 2.0 * std::numbers::pi * settings.laps_before;
    if (point.turned >= sim::CirclePath::lap_end) break;
    // The force at the time of the samples, before the tick moves the plant on.
    std::array<double, 2> force{};
    for (std::size_t k = 0; k < axes; ++k) force[k] = run.plant(k).motor_force();
    const auto set = late ? path.at(run.time()).axes : point.axes;
    run.tick(std::span(set).first(axes), trace);
    std::array<sim::CircleAxisSample, 2> samples;
    for (std::size_t k = 0; k < axes; ++k) {
      const auto& s = run.signals(k);
      samples[k] = {machine::to_si(s.x), machine::to_si(s.e), machine::to_si(s.e_held),
                    force[k] / machine.axes[k].motor.force_constant};
    }
    measurement.add(point, samples);
  }
  auto result = measurement.finish();
  result.friction = friction_in_use(machine);
  for (std::size_t k = 0; k < axes; ++k) result.axes[k].friction = machine.axes[k].friction.use;
  return result;
}

template sim::CircleRun run_circle<FixedSignals>(const machine::Machine&, const sim::CircleSettings&,
                                                 const TraceSink<FixedSignals>&);
template sim::CircleRun run_circle<machine::DoubleSignals>(const machine::Machine&, const sim::CircleSettings&,
                                                           const TraceSink<machine::DoubleSignals>&);

}  // namespace stiction::host
