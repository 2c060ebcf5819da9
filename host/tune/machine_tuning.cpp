#include "host/tune/machine_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "host/simulate/circle.hpp"

namespace stiction::host {
namespace {

// Of an axis: those given, or circles of the machine file's simulation without compensation.
std::vector<Log> logs_of_tuning(machine::Machine machine, std::size_t axis, const std::vector<Log>& given,
                                const TuningCircles& circles) {
  if (!given.empty()) return given;
  machine.axes[axis].friction_compensation.reset();
  std::vector<Log> logs;
  for (const double feed : circles.without_logs)
    logs.push_back(simulated_circle(machine, axis, circle_settings(machine, feed, circles.radius), 2));
  return logs;
}

}  // namespace

TuningCircles tuning_circles(const machine::Machine& machine) {
  TuningCircles circles;
  circles.radius = usual_radius(machine);
  const double highest = circles.feeds.back(), allowed = highest_feed(machine, circles.radius);
  if (allowed >= highest) return circles;
  const auto slower = [&](double& feed) {
    // Two digits in m/min, as feeds are given.
    feed = std::strtod(fmt::format("{:.2g}", feed * allowed / highest * 60.0).c_str(), nullptr) / 60.0;
  };
  for (auto* feeds : {&circles.feeds, &circles.without_logs})
    for (double& feed : *feeds) slower(feed);
  slower(circles.shown);
  slower(circles.timing);
  return circles;
}

TunedCompensations tune_machine(const machine::Machine& machine, const std::vector<Log>& logs,
                                const MachineTuningSettings& settings) {
  const auto circles = tuning_circles(machine);
  const double shown = settings.shown.value_or(circles.shown);
  ComparisonSettings comparison;
  comparison.circle = circle_settings(machine, shown, circles.radius);
  for (const auto& axis : machine.axes) check_circle(axis, comparison.circle);
  comparison.feeds = settings.feeds.empty() ? circles.feeds : settings.feeds;
  if (std::find(comparison.feeds.begin(), comparison.feeds.end(), shown) == comparison.feeds.end())
    comparison.feeds.push_back(shown);
  TunedCompensations all{machine, {}, {}, comparison.circle};
  for (const auto k : settings.axes) {
    CompensationSettings of_axis;
    if (settings.pulse) of_axis.pulse = comparison.circle;
    const auto lap = [&, k](const machine::Machine& with) {
      return simulated_circle(with, k, circle_settings(machine, circles.timing, circles.radius), 2);
    };
    auto tuning = tune_compensation(all.machine, k, logs_of_tuning(machine, k, logs, circles), lap, of_axis);
    all.machine = tuning.machine;
    all.tuned.emplace_back(k, std::move(tuning));
    if (settings.tuned) settings.tuned(machine.axes[k].name);
  }
  if (settings.begin_comparison) settings.begin_comparison(compared_circles(all.machine, comparison));
  comparison.progress = settings.compared;
  all.circles = compare_compensations(all.machine, comparison);
  return all;
}

}  // namespace stiction::host
