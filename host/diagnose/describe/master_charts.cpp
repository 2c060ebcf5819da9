#include "host/diagnose/describe/master_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "host/diagnose/describe/diagnosis_charts.hpp"
#include "host/diagnose/verdict/chart_means.hpp"
#include "host/identify/identification.hpp"
#include "host/log/repeating_motion.hpp"

namespace stiction::host {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr std::size_t places = 180;     // of a cycle, at which values are compared from cycle to cycle
constexpr double highest_order = 60.0;  // of the master or the motor
constexpr std::size_t most_orders = 600;

// At each place of the master the mean over the cycles, and the rms of what is left about it.
struct ByPlace {
  std::vector<double> place, mean, rest;  // deg of the master; the values' unit
  double repeats = 0.0;                   // share of the values' variance
};

ByPlace by_place(const std::vector<double>& master, const std::vector<double>& values) {
  const auto ends = std::minmax_element(master.begin(), master.end());
  const double low = *ends.first, width = std::max(*ends.second - low, 1e-300) / places;
  const auto place_of = [&](std::size_t k) {
    return std::min(static_cast<std::size_t>((master[k] - low) / width), places - 1);
  };
  std::vector<double> count(places, 0.0), sum(places, 0.0), squares(places, 0.0);
  double whole = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    count[place_of(k)] += 1.0;
    sum[place_of(k)] += values[k];
    whole += values[k] / static_cast<double>(values.size());
  }
  double about_mean = 0.0, left = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double rest = values[k] - sum[place_of(k)] / count[place_of(k)];
    squares[place_of(k)] += rest * rest;
    left += rest * rest;
    about_mean += (values[k] - whole) * (values[k] - whole);
  }
  ByPlace found;
  for (std::size_t p = 0; p < places; ++p) {
    if (count[p] < 1.0) continue;
    found.place.push_back(degrees * (low + (static_cast<double>(p) + 0.5) * width));
    found.mean.push_back(sum[p] / count[p]);
    found.rest.push_back(std::sqrt(squares[p] / count[p]));
  }
  found.repeats = about_mean > 0.0 ? 1.0 - left / about_mean : 0.0;
  return found;
}

sim::Chart over_master(std::string title, std::string y_label, std::string caption, const ByPlace& found) {
  sim::Chart chart;
  chart.title = std::move(title);
  chart.x_label = "master, deg";
  chart.y_label = std::move(y_label);
  chart.caption = std::move(caption);
  chart.series = {{.name = "mean of the cycles", .x = found.place, .y = found.mean},
                  {.name = "what differs between them, rms", .x = found.place, .y = found.rest}};
  chart.levels = {0.0};
  return chart;
}

// `one` less `other`, about their mean: encoders have zeros of their own.
std::vector<double> difference(const std::vector<double>& one, const std::vector<double>& other, double factor) {
  std::vector<double> values(one.size());
  double mean = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    values[k] = factor * (one[k] - other[k]);
    mean += values[k] / static_cast<double>(one.size());
  }
  for (double& value : values) value -= mean;
  return values;
}

std::string shares(const ByPlace& found) {
  return fmt::format(
      "{:.0f} % of its variance comes back in each cycle of the master; the rest differs from cycle to "
      "cycle.",
      100.0 * std::clamp(found.repeats, 0.0, 1.0));
}

// Amplitudes of `values` at orders of an angle (rad): integrals over the angle, so that a dwell has no weight.
sim::Series orders(const Eigen::VectorXd& values, const Eigen::VectorXd& angle) {
  sim::Series series;
  const auto n = values.size();
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 1; k + 1 < n; ++k) weight[k] = 0.5 * std::abs(angle[k + 1] - angle[k - 1]);
  const double way = weight.sum();
  if (!(way > 0.0)) return series;
  const Eigen::VectorXd centred = values.array() - values.dot(weight) / way;
  // One turn of the whole way is what can be told apart; between two samples no more than a fifth of a wave.
  const double finest = 2.0 * std::numbers::pi / way, longest_step = weight.maxCoeff();
  const double highest = std::min(highest_order, 0.4 * std::numbers::pi / std::max(longest_step, 1e-300));
  const double step = std::max({0.5 * finest, highest / static_cast<double>(most_orders), 1e-3});
  for (double order = std::max(step, 0.25); order <= highest; order += step) {
    std::complex<double> sum = 0.0;
    for (Eigen::Index k = 0; k < n; ++k) sum += weight[k] * centred[k] * std::polar(1.0, -order * angle[k]);
    series.x.push_back(order);
    series.y.push_back(2.0 * std::abs(sum) / way);
  }
  return series;
}

}  // namespace

void add_master_charts(Verdict& verdict, const std::vector<Log>& logs, const machine::AxisModel& axis,
                       const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const auto& log = logs.front();
  const auto& channels = channels_of(log, axis);
  if (channels.master.empty()) return;
  const auto& units = verdict.units;
  const auto first = rows.logs().size() > 1 ? static_cast<Eigen::Index>(rows.logs()[1]) : rows.rows();
  if (!channels.x_set.empty()) {
    const auto error = by_place(channels.master, difference(channels.x, channels.x_set, units.deviation.factor));
    verdict.before_after.push_back(over_master("Following error over the master",
                                               axis_label("measured minus set position", units.deviation),
                                               shares(error), error));
  }
  if (!channels.x_load.empty()) {
    const auto twist = by_place(channels.master, difference(channels.x_load, channels.x, units.deviation.factor));
    verdict.before_after.push_back(over_master("Difference of the two encoders over the master",
                                               axis_label("second minus first encoder", units.deviation), shares(twist),
                                               twist));
  }

  const Eigen::VectorXd shown_before = units.force.factor * before.head(first);
  const Eigen::VectorXd shown_after = units.force.factor * after.head(first);
  const auto of_first = [&](const std::vector<double>& values) -> Eigen::VectorXd {
    return rows
        .sampled([&](const Motion& motion) {
          return &motion == rows.motions().data() ? values : std::vector<double>(motion.x.size(), 0.0);
        })
        .head(first);
  };
  const Eigen::VectorXd master = of_first(channels.master), position = of_first(channels.x);
  sim::Chart force;
  force.title = "Residual force over the master";
  force.x_label = "master, deg";
  force.y_label = fmt::format("mean of measured minus expected force, {}", units.force.unit);
  force.series = {of_machine_file(even_means("", master, degrees, shown_before)),
                  of_extended(even_means("", master, degrees, shown_after))};
  force.levels = {0.0};
  verdict.before_after.push_back(std::move(force));

  const auto add_orders = [&](const char* of, const Eigen::VectorXd& angle) {
    sim::Chart chart;
    chart.title = fmt::format("Residual force in orders of the {}", of);
    chart.x_label = fmt::format("order: waves in a turn of the {}", of);
    chart.y_label = fmt::format("amplitude, {}", units.force.unit);
    chart.series = {of_machine_file(orders(shown_before, angle)), of_extended(orders(shown_after, angle))};
    if (chart.series.front().x.size() > 1) verdict.before_after.push_back(std::move(chart));
  };
  add_orders("master", of_first(unwound(channels.master).turned));
  if (axis.transmission && axis.motor_coordinate.radius > 0.0)
    add_orders("motor", position / axis.motor_coordinate.radius);
}

}  // namespace stiction::host
