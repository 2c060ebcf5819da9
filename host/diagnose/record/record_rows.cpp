#include "host/diagnose/record/record_rows.hpp"

#include <algorithm>
#include <utility>

#include "host/diagnose/record/held_still.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/identification.hpp"
#include "host/identify/suitability.hpp"

namespace stiction::host {
namespace {

constexpr double row_band = 0.4;  // of the rows' rate
// Of the wide band: what a diagnosis has the memory for.
constexpr double highest_row_rate = 1000.0;  // Hz
constexpr double most_rows = 30e3;

}  // namespace

SignalSettings signals_in(RowBand band, std::span<const Log> logs) {
  double rate = 0.0, seconds = 0.0;  // Hz, of the slowest log; of all
  for (const auto& log : logs) {
    rate = rate == 0.0 ? 1.0 / log.period : std::min(rate, 1.0 / log.period);
    seconds += static_cast<double>(log.t.size()) * log.period;
  }
  SignalSettings s;
  s.row_rate = 250.0;  // 0 to 100 Hz
  s.cutoff = 250.0;    // of the position alone, so well above: what it took off m a at 100 Hz the force still has
  if (rate == 0.0) return s;
  if (band == RowBand::wide) {
    // A run of the file is taken off the record through the same filters, so that what these take off both is no force.
    s.highest = 0.4;
    s.row_rate = s.cutoff = std::max(s.row_rate, std::min(highest_row_rate, most_rows / seconds));
  }
  // Rows of a slower log hold frequencies up to half of this share of its rate. Rows that come faster than that needs
  // say little of their own, and what they say above the filter's edge is rounding, which whitening would take for
  // evidence.
  s.row_rate = std::min(s.row_rate, 1.25 * s.highest * rate);
  s.cutoff = std::min(s.cutoff, s.highest * rate);
  return s;
}

double end_of_band(const SignalSettings& settings) { return row_band * settings.row_rate; }

Log part_of(const Log& log, std::size_t begin, std::size_t end) {
  const auto cut = [&](const std::vector<double>& values) {
    return values.empty() ? values
                          : std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                values.begin() + static_cast<std::ptrdiff_t>(end));
  };
  Log part = log;
  part.t = cut(log.t);
  for (auto& axis : part.axes) {
    for (const auto& channel : log_channels) axis.*channel.values = cut(axis.*channel.values);
    for (auto* values : {&axis.x_load, &axis.supply}) *values = cut(*values);
    if (!axis.left_out.empty())
      axis.left_out = {axis.left_out.begin() + static_cast<std::ptrdiff_t>(begin),
                       axis.left_out.begin() + static_cast<std::ptrdiff_t>(end)};
  }
  return part;
}

void count_from_start(Log& log) {
  const double start = log.t.empty() ? 0.0 : log.t.front();
  for (double& t : log.t) t -= start;
}

LogRows rows_of(const std::vector<Log>& logs, const machine::AxisModel& axis, const SignalSettings& settings) {
  std::vector<Motion> motions;
  for (const auto& log : logs) {
    require_samples(log);
    const auto& channels = channels_of(log, axis);
    refuse_saturation(log, channels, axis);
    motions.push_back(motion_of(log, channels, axis, Amperes::amplitude, settings));
  }
  return {std::move(motions), settings};
}

Eigen::VectorXd expected_force(const LogRows& rows, const machine::AxisModel& axis) {
  return rows.stacked([&](const Motion& m) { return force_along(axis, m); });
}

Eigen::VectorXd own_residual(const std::vector<Log>& replayed, const std::vector<Log>& logs,
                             const machine::AxisModel& axis, const SignalSettings& settings) {
  auto records = replayed;
  for (std::size_t k = 0; k < records.size(); ++k)
    records[k].axes.front().external_force = channels_of(logs[k], axis).external_force;
  const auto rows = rows_of(records, axis, settings);
  if (!runs_hold_still(axis)) return rows.force - expected_force(rows, axis);
  const auto measured = rows_of(logs, axis, settings);
  return RecordsBesideRuns(logs, measured, axis, settings).left_of(rows);
}

Eigen::VectorXd mean_own_residual(const std::vector<std::vector<Log>>& runs, const std::vector<Log>& logs,
                                  const machine::AxisModel& axis, const SignalSettings& settings) {
  Eigen::VectorXd sum = own_residual(runs.front(), logs, axis, settings);
  for (std::size_t k = 1; k < runs.size(); ++k) sum += own_residual(runs[k], logs, axis, settings);
  return sum / static_cast<double>(runs.size());
}

}  // namespace stiction::host
