#include "host/diagnose/record/replay_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/diagnose/statistics/coherent_mean.hpp"
#include "host/identify/identification.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/replay.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

// Of the stroke: a simulated position that is further away, rms, is another motion. Within an increment of the encoder
// there is no telling: a record of a few increments, or of none, goes every way.
constexpr double another_way = 0.03;
constexpr double fine = 0.01;              // of the position controller's increment
constexpr std::size_t answers_kept = 6;    // of each log: a grid has two of backlash
constexpr std::size_t usual_runs = 2;      // a third one is half as much work again and names no more of a small gap
constexpr std::size_t most_runs_ever = 8;  // of a swing that keeps its phase for seconds two runs may agree by chance
constexpr std::size_t runs_of_disturbance = 4;
constexpr double much_chance = 0.25;  // of the disturbance's square

bool same_way(const std::vector<double>& simulated, const std::vector<double>& measured, double increment) {
  double mean = 0.0, square = 0.0;
  const double n = static_cast<double>(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) mean += (simulated[i] - measured[i]) / n;
  for (std::size_t i = 0; i < measured.size(); ++i) square += std::pow(simulated[i] - measured[i] - mean, 2) / n;
  const auto [low, high] = std::minmax_element(measured.begin(), measured.end());
  return std::sqrt(square) < std::max(another_way * (*high - *low), increment);
}

// So fine that the axis does not hunt in it, but no finer than the drive's number format holds.
double fine_increment(double increment) {
  constexpr double finest = 1.0 / static_cast<double>(FixedSignals::IncrementInverse::highest_raw);  // m
  return std::max(fine * increment, std::min(increment, finest));
}

bool same(std::span<const machine::Effect> one, std::span<const machine::Effect> other) {
  return std::equal(
      one.begin(), one.end(), other.begin(), other.end(),
      [](const machine::Effect& a, const machine::Effect& b) { return a.name == b.name && a.values == b.values; });
}

// With the channels that decide where the motor's force is taken from.
Log replayed_like(const machine::Machine& machine, const Log& log) {
  auto replayed = replay_linear_as_held(machine, log, {machine.axes.front().name});
  if (log.axes.front().force.empty()) replayed.axes.front().force.clear();
  return replayed;
}

}  // namespace

void without_windings(machine::AxisModel& axis) {
  if (axis.motor.model == machine::MotorModel::synchronous) axis.motor.model = machine::MotorModel::dc;
}

ReplaySetup replay_setup_of(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                            bool coupled) {
  ReplaySetup setup{machine, {}};
  setup.machine.axes = {machine.axes[axis]};
  coupled = coupled && machine.axes.size() == 2;
  if (coupled) setup.machine.axes.push_back(machine.axes[1 - axis]);
  for (const auto& log : logs) {
    const auto& channels = channels_of(log, machine.axes[axis]);
    if (channels.x_set.empty()) continue;
    auto own = log;
    own.axes = {channels};
    if (coupled && !channels_of(log, machine.axes[1 - axis]).x_set.empty())
      own.axes.push_back(channels_of(log, machine.axes[1 - axis]));
    setup.logs.push_back(std::move(own));
  }
  return setup;
}

std::string why_not_simulated(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                              bool coupled) {
  if (machine.axes[axis].unknown_controller())
    return fmt::format("The controller of axis {} is not known", machine.axes[axis].name);
  for (const auto& log : logs)
    for (std::size_t k = 0; k < machine.axes.size(); ++k) {
      if (k != axis && !(coupled && machine.axes.size() == 2)) continue;
      if (k != axis && log.axes.size() != 2) continue;
      const auto why = refused_injection(channels_of(log, machine.axes[k]), machine.axes[k]);
      if (!why.empty()) return fmt::format("{}: {}", log.source, why);
    }
  return "";
}

std::vector<Log> replays(const ReplaySetup& setup) {
  std::vector<Log> all;
  for (const auto& log : setup.logs) all.push_back(replayed_like(setup.machine, log));
  return all;
}

std::vector<std::vector<double>> simulated_positions(const ReplaySetup& setup) {
  std::vector<std::vector<double>> all;
  for (auto& log : replays(setup)) all.push_back(std::move(log.axes.front().x));
  return all;
}

WithoutNoise without_noise(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                           Following how) {
  auto setup = replay_setup_of(machine, axis, logs);
  if (setup.logs.size() != logs.size() || !why_not_simulated(machine, axis, logs).empty()) return {};
  setup.machine.axes.front().encoder.noise = 0.0;
  try {
    WithoutNoise without{logs, replays(setup)};
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto& measured = channels_of(logs[k], machine.axes[axis]);
      const auto& position = without.replayed[k].axes.front().x;
      if (how == Following::as_recorded && !same_way(position, measured.x, machine.axes[axis].encoder.increment))
        return {};
      without.motion[k].axes[static_cast<std::size_t>(&measured - logs[k].axes.data())].x = position;
    }
    return without;
  } catch (const FaultTripped&) {
    return {};
  }
}

EffectResponse::EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                               const SignalSettings& settings, FrictionAlong friction, QuantizerLimitCycle limit_cycle,
                               const std::vector<Log>& replayed)
    : settings_(settings), friction_(friction) {
  auto setup = replay_setup_of(machine, axis, logs);
  machine_ = std::move(setup.machine);
  auto& own = machine_.axes.front();
  own.encoder.noise = 0.0;
  for (auto& log : setup.logs) records_.push_back({std::move(log), {}, {}, {}});
  for (std::size_t k = 0; k < replayed.size(); ++k) take_silent(records_[k], replayed[k]);
  if (limit_cycle == QuantizerLimitCycle::simulated) return;
  own.position_controller.increment = fine_increment(own.position_controller.increment);
  without_windings(own);
}

EffectResponse::EffectResponse(const machine::Machine& machine, std::size_t axis, const std::vector<Log>& logs,
                               const SignalSettings& settings, FrictionAlong friction, const Disturbance& disturbance,
                               const std::vector<Log>& replayed)
    : EffectResponse(machine, axis, logs, settings, friction, QuantizerLimitCycle::simulated, replayed) {
  without_windings(machine_.axes.front());
  disturbance_ = disturbance;
}

Log EffectResponse::disturbed(std::size_t record, std::size_t run) const {
  auto log = records_[record].log;
  if (!disturbance_) return log;
  auto& force = log.axes.front().external_force;
  force.resize(log.t.size(), 0.0);
  const auto drawn = disturbance_.drawn(log.t, record * most_runs_ever + run);
  std::transform(force.begin(), force.end(), drawn.begin(), force.begin(), std::plus<>());
  return log;
}

std::vector<double> EffectResponse::residual(const Record& record, Log simulated,
                                             const std::vector<double>& external_force) const {
  const auto file = sim::plant_axis(machine_.axes.front());
  simulated.axes.front().external_force = external_force;
  const auto motion =
      motion_of(simulated, simulated.axes.front(), machine_.axes.front(), Amperes::amplitude, settings_);
  auto force = motion.force;
  const auto expected = force_along(file, motion);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] -= expected[i];
  if (friction_ == FrictionAlong::own_motion || record.friction.empty()) return force;
  const auto own = friction_along(file, motion);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += own[i] - record.friction[i];
  return force;
}

std::size_t EffectResponse::index_of(const Motion& motion) const {
  const auto found = std::find_if(records_.begin(), records_.end(), [&](const Record& record) {
    return record.log.source == motion.source && record.log.axes.front().x_set == motion.x_set;
  });
  if (found == records_.end()) throw std::out_of_range("no log of " + motion.source);
  return static_cast<std::size_t>(found - records_.begin());
}

const std::vector<double>& EffectResponse::silent(Record& record) const {
  if (record.silent.empty()) take_silent(record, replayed_like(machine_, record.log));
  return record.silent;
}

void EffectResponse::take_silent(Record& record, const Log& replayed) const {
  record.silent = residual(record, replayed, record.log.axes.front().external_force);
  if (friction_ == FrictionAlong::own_motion) return;
  const auto& axis = machine_.axes.front();
  record.friction = friction_along(sim::plant_axis(axis),
                                   motion_of(replayed, replayed.axes.front(), axis, Amperes::amplitude, settings_));
}

void EffectResponse::take_silence(std::span<const std::vector<Log>> runs) {
  for (std::size_t k = 0; k < records_.size(); ++k) {
    std::vector<double> sum(records_[k].log.t.size(), 0.0);
    for (const auto& run : runs) {
      take_silent(records_[k], run[k]);
      std::transform(sum.begin(), sum.end(), records_[k].silent.begin(), sum.begin(), std::plus<>());
    }
    for (double& force : sum) force /= static_cast<double>(runs.size());
    records_[k].silent = std::move(sum);
  }
}

const std::vector<double>& EffectResponse::without(std::size_t index, std::size_t run) {
  auto& record = records_[index];
  const auto& in_silence = silent(record);
  if (!disturbance_) return in_silence;
  while (record.without.size() <= run) {
    const auto log = disturbed(index, record.without.size());
    record.without.push_back(residual(record, replayed_like(machine_, log), log.axes.front().external_force));
  }
  return record.without[run];
}

// Of runs with the effects, each less the one without under the same forces.
std::vector<double> EffectResponse::common(std::size_t index, const machine::Machine& machine, std::size_t most_runs) {
  CoherentMean part;
  const std::size_t most = disturbance_ ? std::min(most_runs, most_runs_ever) : 1;
  for (std::size_t r = 0; r < most; ++r) {
    if (r >= usual_runs && part.chance() < much_chance * disturbance_.mean_square()) break;
    const auto& own = without(index, r);
    const auto log = disturbed(index, r);
    auto force = residual(records_[index], replayed_like(machine, log), log.axes.front().external_force);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= own[i];
    part.add(force);
  }
  return part.estimate();
}

std::vector<double> EffectResponse::of_disturbance(const Motion& motion) {
  const auto k = index_of(motion);
  if (!disturbance_) return std::vector<double>(motion.t.size(), 0.0);
  try {
    CoherentMean part;
    for (std::size_t r = 0; r < runs_of_disturbance; ++r) {
      auto force = without(k, r);
      const auto& own = silent(records_[k]);
      for (std::size_t i = 0; i < force.size(); ++i) force[i] -= own[i];
      part.add(force);
    }
    return part.estimate();
  } catch (const FaultTripped&) {
    return std::vector<double>(motion.t.size(), 0.0);
  }
}

std::vector<double> EffectResponse::operator()(const Motion& motion, const machine::Effect& effect,
                                               std::size_t most_runs) {
  return together(motion, {&effect, 1}, most_runs);
}

std::vector<double> EffectResponse::together(const Motion& motion, std::span<const machine::Effect> effects,
                                             std::size_t most_runs) {
  const auto k = index_of(motion);
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& each) {
    return each.record == k && each.runs == most_runs && same(each.effects, effects);
  });
  if (known != known_.end()) return known->force;
  auto machine = machine_;
  auto& acting = machine.axes.front().effects;
  acting.insert(acting.end(), effects.begin(), effects.end());
  try {
    known_.push_back({k, most_runs, {effects.begin(), effects.end()}, common(k, machine, most_runs)});
    if (known_.size() > answers_kept * records_.size()) known_.pop_front();
    return known_.back().force;
  } catch (const FaultTripped&) {
    return std::vector<double>(motion.t.size(), 0.0);
  }
}

}  // namespace stiction::host
