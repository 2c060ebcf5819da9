#include "host/diagnose/judge/command_rows.hpp"

#include <algorithm>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/diagnose/classes/command_parameter.hpp"
#include "host/diagnose/record/command_replay.hpp"
#include "host/diagnose/record/moved_values.hpp"
#include "host/identify/filter.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/regression.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// Of the command, by which a slope's step may change it: what follows positions that are given has no loop to hold it,
// and one tick of delay can drive a stiff axis to its limits.
constexpr double most_changed = 0.1;
constexpr int tries = 6;

}  // namespace

CommandRows::CommandRows(const CommandRecords& records, const machine::Timing& timing, const machine::AxisModel& axis,
                         double record_delay)
    : records_(records), timing_(timing), axis_(axis) {
  std::vector<std::vector<double>> logged, rates;
  for (std::size_t k = 0; k < records.logs.size(); ++k) {
    const auto& log = records.logs[k];
    const auto& channels = channels_of(log, axis);
    auto values = channels.*(recorded_command(channels, axis)->values);
    logged.push_back(shown_earlier(values, record_delay / log.period));
    if (record_delay != 0.0) rates.push_back(rate_over(logged.back(), log.period));
    const std::size_t samples = rows().motions()[k].t.size();
    std::vector<double> line(samples);
    for (std::size_t i = 0; i < samples; ++i)
      line[i] = 2.0 * static_cast<double>(i) / static_cast<double>(samples) - 1.0;
    nuisances_.push_back(rows().of_log(k, std::vector<double>(samples, 1.0)));
    nuisances_.push_back(rows().of_log(k, line));
  }
  logged_ = rows_of(logged);
  if (!rates.empty()) nuisances_.push_back(rows_of(rates));
}

template <class S>
Eigen::VectorXd CommandRows::replayed(const machine::AxisModel& axis, std::span<const Log> logs) const {
  std::vector<std::vector<double>> all;
  for (const auto& log : logs) all.push_back(replay_command<S>(timing_, axis, log, channels_of(log, axis_)));
  return rows_of(all);
}

Eigen::VectorXd CommandRows::as_driven(const machine::AxisModel& axis) const {
  return axis.beyond_formats.empty() ? replayed<FixedSignals>(axis, records_.logs)
                                     : replayed<machine::DoubleSignals>(axis, records_.logs);
}

std::vector<Eigen::VectorXd> CommandRows::slopes(const machine::AxisModel& axis,
                                                 std::span<const std::size_t> places) const {
  std::vector<Eigen::VectorXd> all;
  const auto logs = records_.simulated.size() == records_.logs.size() ? records_.simulated : records_.logs;
  const auto base = replayed<machine::DoubleSignals>(axis, logs);
  for (const auto place : places) {
    const auto& parameter = command_parameters()[place];
    double step = parameter.step(axis, timing_);
    Eigen::VectorXd change;
    for (int k = 0; k < tries; ++k) {
      auto changed = axis;
      parameter.set(changed, *parameter.value(axis) + step);
      change = replayed<machine::DoubleSignals>(changed, logs) - base;
      const double size = rms(change) / rms(base);
      if (!(size > most_changed)) break;
      step *= 0.5 * most_changed / size;
    }
    all.push_back(change / step);
  }
  return all;
}

Eigen::VectorXd CommandRows::shown(Eigen::VectorXd values) const {
  for (std::size_t k = 0; k < rows().logs().size(); ++k) {
    const std::size_t begin = rows().logs()[k];
    const std::span<double> own(values.data() + begin, rows().end(k) - begin);
    const auto lowpass = butterworth(2, std::min(2.0 * slowest_shown * rows().period(k), 0.5));
    const auto slow = filter_both_ways(lowpass, own, own.size() / 4);
    for (std::size_t i = 0; i < own.size(); ++i) own[i] -= slow[i];
  }
  return values;
}

Eigen::VectorXd CommandRows::rows_of(const std::vector<std::vector<double>>& columns) const {
  return rows().stacked(
      [&](const Motion& motion) { return columns[static_cast<std::size_t>(&motion - rows().motions().data())]; });
}

}  // namespace stiction::host
