#include "host/simulate/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/log/own_units.hpp"
#include "host/simulate/endless_counter.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/replay_motion.hpp"
#include "host/simulate/replay_sampler.hpp"
#include "sim/effects/effects.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
std::vector<std::size_t> match_axes(const machine::Machine& machine, const Log& log, const std::string& axis) {
  std::string known;
  for (const auto& each : machine.axes) known += (known.empty() ? "" : ", ") + each.name;
  const auto index_of = [&](const std::string& name) {
    for (std::size_t k = 0; k < machine.axes.size(); ++k)
      if (machine.axes[k].name == name) return k;
    throw LogError(fmt::format("{}: found the axis {}; expected one of {}: {}", log.source, name, machine.id, known));
  };
  std::vector<std::size_t> indices;
  for (const auto& each : log.axes) {
    if (!each.axis.empty())
      indices.push_back(index_of(each.axis));
    else if (!axis.empty())
      indices.push_back(index_of(axis));
    else if (machine.axes.size() == 1)
      indices.push_back(0);
    else
      throw LogError(
          fmt::format("{}: found channels without an axis, and {} has several; expected --axis with one of: "
                      "{}",
                      log.source, machine.id, known));
  }
  return indices;
}

template <class S>
Log replay_linear(const machine::Machine& machine, const Log& log, const ReplaySettings& settings,
                  const TraceSink<S>& trace) {
  const auto indices = match_axes(machine, log, settings.axis);
  std::vector<ReplayMotion> motions;
  std::vector<Injection> injections;
  std::vector<double> start(machine.axes.size(), 0.0);
  double lead_in = 0.0;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    motions.emplace_back(log, log.axes[k], machine.axes[indices[k]]);
    injections.emplace_back(log, log.axes[k], machine.axes[indices[k]]);
    lead_in = std::max(lead_in, motions.back().lead_in());
  }
  const double zero = replay_zero(machine, log, lead_in);  // on the log's clock
  for (std::size_t k = 0; k < indices.size(); ++k) start[indices[k]] = motions[k].at(zero).position;

  ControlRun<S> run(machine, start);
  ReplaySampler sampler(log, indices, machine);
  std::vector<sim::AxisSetPoint> points(machine.axes.size());
  std::vector<ReplaySample> values(indices.size());
  std::vector<EndlessCounter> counters;
  for (const std::size_t index : indices) counters.emplace_back(machine.axes[index]);
  while (!sampler.done()) {
    const double t = zero + run.time();
    for (std::size_t k = 0; k < indices.size(); ++k) {
      points[indices[k]] = motions[k].at(t);
      points[indices[k]].injection = injections[k].at(t);
      auto& plant = run.plant(indices[k]);
      if (!log.axes[k].external_force.empty()) plant.set_external_force(at_time(log, log.axes[k].external_force, t));
      values[k].force = plant.motor_force();
      values[k].x_load = plant.read_second_encoder().value_or(0.0);
    }
    run.tick(points, trace);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const auto& s = run.signals(indices[k]);
      values[k] = {machine::to_si(s.x),     machine::to_si(s.v), machine::to_si(s.i),
                   machine::to_si(s.i_set), values[k].force,     values[k].x_load};
      if (!counters[k].counts_phase()) continue;
      counters[k].see(run.encoder_counts(indices[k]));
      values[k].phase = counters[k].phase();
    }
    sampler.add(t, values);
  }
  auto out = sampler.finish();
  for (std::size_t k = 0; k < indices.size(); ++k)
    finish_replay(out.axes[k], log.axes[k], machine.axes[indices[k]], motions[k]);
  return out;
}

template <class S>
Log replay(const machine::Machine& machine, const Log& log, const ReplaySettings& settings, const TraceSink<S>& trace) {
  const auto indices = match_axes(machine, log, settings.axis);
  const auto coordinate = [&](std::size_t k) { return machine.axes[indices[k]].coordinate; };
  bool any = false;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    require_same_kind(log, log.axes[k], machine.axes[indices[k]]);
    any = any || coordinate(k).rotary();
  }
  if (!any) return replay_linear<S>(machine, log, settings, trace);
  Log linear = log;
  for (std::size_t k = 0; k < indices.size(); ++k) linear.axes[k] = as_linear(std::move(linear.axes[k]), coordinate(k));
  Log out = replay_linear<S>(machine, linear, settings, trace);
  for (std::size_t k = 0; k < indices.size(); ++k) out.axes[k] = in_own_units(std::move(out.axes[k]), coordinate(k));
  return out;
}

Log replay_linear_as_held(const machine::Machine& machine, const Log& log, const ReplaySettings& settings) {
  return machine.fits_formats() ? replay_linear<FixedSignals>(machine, log, settings)
                                : replay_linear<machine::DoubleSignals>(machine, log, settings);
}

template Log replay_linear<FixedSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                         const TraceSink<FixedSignals>&);
template Log replay_linear<machine::DoubleSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                                   const TraceSink<machine::DoubleSignals>&);
template Log replay<FixedSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                  const TraceSink<FixedSignals>&);
template Log replay<machine::DoubleSignals>(const machine::Machine&, const Log&, const ReplaySettings&,
                                            const TraceSink<machine::DoubleSignals>&);

}  // namespace stiction::host
