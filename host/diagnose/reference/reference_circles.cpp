#include "host/diagnose/reference/reference_circles.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/diagnose/reference/reference_extension.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/quadrant_run.hpp"
#include "sim/effects/cross_axis_coupling/cross_axis_coupling.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

// Where no axis feels the other, each runs alone, and nothing of the lap is kept but its figures.
RowFigures drive_alone(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& settings) {
  const machine::Machine one = one_axis(machine, axis);
  const sim::CirclePath path(settings);
  const std::array<double, 1> start{path.at(0.0).axes[axis].position};
  ControlRun<machine::DoubleSignals> run(one, start);
  const double force_constant = machine.axes[axis].motor.force_constant;
  RowFigures peak;
  for (;;) {
    const double turned = path.at(std::max(0.0, run.set_point_time())).turned;
    if (turned >= sim::CirclePath::lap_end) return peak;
    // The force at the time of the samples, before the tick moves the plant on.
    const double current = run.plant(0).motor_force() / force_constant;
    const std::array<sim::AxisSetPoint, 1> set{path.at(run.time()).axes[axis]};
    run.tick(set);
    if (turned < sim::CirclePath::lap_begin) continue;
    peak.error = std::max(peak.error, std::abs(machine::to_si(run.signals(0).e)));
    peak.current = std::max(peak.current, std::abs(current));
  }
}

bool coupled(const machine::Machine& machine) {
  return std::ranges::any_of(machine.axes, [](const machine::AxisModel& axis) {
    return std::ranges::any_of(axis.effects,
                               [](const machine::Effect& e) { return sim::is_a<sim::CrossAxisCoupling>(e); });
  });
}

}  // namespace

std::array<RowFigures, 2> ReferenceCircles::at(const machine::Machine& machine, double feed) {
  std::array<RowFigures, 2> figures;
  if (coupled(machine)) {
    const auto run = reference_circle(machine, feed);
    for (std::size_t k = 0; k < figures.size(); ++k)
      figures[k] = {run.axes.at(k).peak_error, run.axes.at(k).peak_current};
    return figures;
  }
  sim::CircleSettings settings;
  settings.feed = feed;
  check_circle(machine, settings);
  for (std::size_t k = 0; k < figures.size(); ++k) {
    Key key{k, feed, {}};
    for (const auto& effect : machine.axes.at(k).effects) key.effects.emplace_back(effect.name, effect.values);
    auto known = driven_.find(key);
    if (known == driven_.end()) known = driven_.emplace(std::move(key), drive_alone(machine, k, settings)).first;
    figures[k] = known->second;
  }
  return figures;
}

}  // namespace stiction::host
