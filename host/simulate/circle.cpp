#include "host/simulate/circle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/simulate/friction_choice.hpp"
#include "sim/experiment/circle_measurement.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double metre_per_minute = 1.0 / 60.0;  // m/s

}  // namespace

void check_circle(const machine::Machine& machine, const sim::CircleSettings& settings) {
  if (machine.axes.size() != 2)
    throw InfeasibleMotion(fmt::format("circle: found a machine with {} axes; expected 2", machine.axes.size()));
  for (const auto& axis : machine.axes) {
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
}

template <class S>
sim::CircleRun run_circle(const machine::Machine& machine, const sim::CircleSettings& settings,
                          const TraceSink<S>& trace) {
  check_circle(machine, settings);
  const sim::CirclePath path(settings);
  const auto start = path.at(0.0);
  const std::array<double, 2> positions{start.axes[0].position, start.axes[1].position};
  ControlRun<S> run(machine, positions);
  const bool late = machine::set_point_delay(machine) > 0.0;
  sim::CircleMeasurement measurement(settings, machine.timing.fast_period,
                                     {machine.axes[0].name, machine.axes[1].name});
  for (;;) {
    auto point = path.at(std::max(0.0, run.set_point_time()));
    point.turned -= 2.0 * std::numbers::pi * settings.laps_before;
    if (point.turned >= sim::CirclePath::lap_end) break;
    // The force at the time of the samples, before the tick moves the plant on.
    const std::array<double, 2> force{run.plant(0).motor_force(), run.plant(1).motor_force()};
    run.tick(late ? path.at(run.time()).axes : point.axes, trace);
    std::array<sim::CircleAxisSample, 2> samples;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& s = run.signals(k);
      samples[k] = {machine::to_si(s.x), machine::to_si(s.e), machine::to_si(s.e_held),
                    force[k] / machine.axes[k].motor.force_constant};
    }
    measurement.add(point, samples);
  }
  auto result = measurement.finish();
  result.friction = friction_in_use(machine);
  for (std::size_t k = 0; k < 2; ++k) result.axes[k].friction = machine.axes[k].friction.use;
  return result;
}

template sim::CircleRun run_circle<FixedSignals>(const machine::Machine&, const sim::CircleSettings&,
                                                 const TraceSink<FixedSignals>&);
template sim::CircleRun run_circle<machine::DoubleSignals>(const machine::Machine&, const sim::CircleSettings&,
                                                           const TraceSink<machine::DoubleSignals>&);

}  // namespace stiction::host
