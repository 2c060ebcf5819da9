#include "host/diagnose/record/cycle_mean.hpp"

#include <algorithm>
#include <cmath>

#include "host/identify/identification.hpp"
#include "host/log/repeating_motion.hpp"

namespace stiction::host {
namespace {

// Of one log: `values` of its rows at `times` (s) from its start, in cycles of `period` s.
void take_mean(Eigen::Ref<Eigen::VectorXd> values, const Eigen::VectorXd& times, double period, double step) {
  const auto places = static_cast<Eigen::Index>(period / step);
  if (places < 2 || times[times.size() - 1] - times[0] < 2.0 * period) return;
  const auto place_of = [&](Eigen::Index row) {
    const double cycles = (times[row] - times[0]) / period;
    return std::min(static_cast<Eigen::Index>((cycles - std::floor(cycles)) * static_cast<double>(places)), places - 1);
  };
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(places), count = Eigen::VectorXd::Zero(places);
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    if (values[row] == 0.0) continue;
    sum[place_of(row)] += values[row];
    count[place_of(row)] += 1.0;
  }
  for (Eigen::Index row = 0; row < values.size(); ++row) {
    if (values[row] == 0.0) continue;
    const double n = count[place_of(row)], mean = sum[place_of(row)] / count[place_of(row)];
    values[row] = (values[row] - mean) * std::sqrt(n / std::max(n - 1.0, 1.0));
  }
}

}  // namespace

Eigen::VectorXd without_cycle_mean(Eigen::VectorXd values, const LogRows& rows, const std::vector<Log>& logs,
                                   const machine::AxisModel& axis) {
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto& channels = channels_of(logs[k], axis);
    if (channels.master.empty() || channels.x_set.empty()) continue;
    const auto repeats = repeating_motion(logs[k], channels, SetPoints(logs[k], channels));
    if (!repeats) continue;
    const auto begin = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = k + 1 < rows.logs().size() ? static_cast<Eigen::Index>(rows.logs()[k + 1]) : values.size();
    if (end - begin < 4) continue;
    take_mean(values.segment(begin, end - begin), rows.time.segment(begin, end - begin), repeats->period,
              rows.period(k));
  }
  return values;
}

}  // namespace stiction::host
