#include "host/diagnose/record/replay_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "host/identify/identification.hpp"
#include "host/simulate/injection.hpp"
#include "host/simulate/replay.hpp"
#include "host/simulate/replay_together.hpp"

namespace stiction::host {
namespace {

// Of the stroke: a simulated position that is further away, rms, is another motion. Within an increment of the encoder
// there is no telling: a record of a few increments, or of none, goes every way.
constexpr double another_way = 0.03;

bool same_way(const std::vector<double>& simulated, const std::vector<double>& measured, double increment) {
  double mean = 0.0, square = 0.0;
  const double n = static_cast<double>(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) mean += (simulated[i] - measured[i]) / n;
  for (std::size_t i = 0; i < measured.size(); ++i) square += std::pow(simulated[i] - measured[i] - mean, 2) / n;
  const auto [low, high] = std::minmax_element(measured.begin(), measured.end());
  return std::sqrt(square) < std::max(another_way * (*high - *low), increment);
}

// Whether replays go the way of the logs, with the channels of this axis first.
bool goes_along(const std::vector<Log>& replayed, const std::vector<Log>& logs, const machine::AxisModel& axis) {
  for (std::size_t k = 0; k < logs.size(); ++k)
    if (!same_way(replayed[k].axes.front().x, logs[k].axes.front().x, axis.encoder.increment)) return false;
  return true;
}

// With the channels that decide where the motor's force is taken from.
Log with_force_as(Log replayed, const Log& recorded) {
  if (recorded.axes.front().force.empty()) replayed.axes.front().force.clear();
  return replayed;
}

}  // namespace

void without_windings(machine::AxisModel& axis) {
  if (axis.motor.model == machine::MotorModel::synchronous) axis.motor.model = machine::MotorModel::dc;
}

machine::Machine machine_of_axis(const machine::Machine& machine, std::size_t axis) {
  auto alone = machine;
  alone.axes = {machine.axes[axis]};
  return alone;
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
  for (const auto& log : setup.logs)
    all.push_back(with_force_as(replay_linear_as_held(setup.machine, log, {setup.machine.axes.front().name}), log));
  return all;
}

std::vector<std::optional<std::vector<Log>>> replays_together(const machine::Machine& machine,
                                                              std::span<const std::vector<Log>> records) {
  std::vector<ReplayOf> which;
  for (const auto& logs : records)
    for (const auto& log : logs) which.push_back({&machine, &log});
  std::vector<machine::Machine> noisy;
  if (machine.axes.front().encoder.noise > 0.0) {
    noisy.assign(which.size(), machine);
    for (std::size_t k = 0; k < noisy.size(); ++k) {
      noisy[k].axes.front().encoder.noise_draw += k;
      which[k].machine = &noisy[k];
    }
  }
  auto replayed = replay_together(which);
  std::vector<std::optional<std::vector<Log>>> all;
  auto next = replayed.begin();
  for (const auto& logs : records) {
    auto& runs = all.emplace_back(std::in_place);
    for (const auto& log : logs) {
      if (auto* run = std::get_if<Log>(&*next++); run == nullptr)
        runs.reset();
      else if (runs)
        runs->push_back(with_force_as(std::move(*run), log));
    }
  }
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
    if (how == Following::as_recorded && !goes_along(without.replayed, setup.logs, machine.axes[axis])) return {};
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto& measured = channels_of(logs[k], machine.axes[axis]);
      const auto& position = without.replayed[k].axes.front().x;
      without.motion[k].axes[static_cast<std::size_t>(&measured - logs[k].axes.data())].x = position;
    }
    return without;
  } catch (const FaultTripped&) {
    return {};
  }
}

std::vector<std::vector<Log>> runs_without_noise(const machine::Machine& machine, std::size_t axis,
                                                 std::span<const std::vector<Log>> records, Following how) {
  std::vector<std::vector<Log>> driven;
  for (const auto& logs : records) {
    auto own = replay_setup_of(machine, axis, logs).logs;
    if (own.size() != logs.size() || !why_not_simulated(machine, axis, logs).empty())
      return std::vector<std::vector<Log>>(records.size());
    driven.push_back(std::move(own));
  }
  auto alone = machine_of_axis(machine, axis);
  alone.axes.front().encoder.noise = 0.0;
  const auto replayed = replays_together(alone, driven);
  std::vector<std::vector<Log>> runs(records.size());
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (replayed[k] && (how != Following::as_recorded || goes_along(*replayed[k], driven[k], machine.axes[axis])))
      runs[k] = *replayed[k];
  return runs;
}

}  // namespace stiction::host
