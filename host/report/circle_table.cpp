// The figures of a circle beside the machine's published and measured rows: see circle_table.hpp.
#include "host/report/circle_table.hpp"

#include <algorithm>
#include <cmath>

#include "host/report/reference_lookup.hpp"

namespace stiction::host {
namespace {

constexpr double current_tolerance = 0.05;     // of the published current; two correct simulations agree to 1.6 % in
                                               // the mean, and the published figures carry two digits
constexpr double increment_if_unknown = 1e-6;  // m, where the position controller does not quantise

std::optional<double> relative(const std::optional<double>& measured, double simulated) {
  if (!measured || *measured == 0.0) return std::nullopt;
  return (*measured - simulated) / *measured;
}

double increment_of(const machine::Machine& machine, std::string_view axis) {
  const auto found =
      std::find_if(machine.axes.begin(), machine.axes.end(), [&](const auto& a) { return a.name == axis; });
  const double increment = found == machine.axes.end() ? 0.0 : found->position_controller.increment;
  return increment > 0.0 ? increment : increment_if_unknown;
}

CircleTableRow make_row(const sim::CircleRun& run, const sim::AxisLap& lap, const machine::Machine& machine) {
  CircleTableRow row{lap.axis, run.friction, run.feed, run.direction, {}, {}, {}};
  row.error.simulated = lap.peak_error;
  row.error_quantised.simulated = lap.peak_error_quantised;
  row.current.simulated = lap.peak_current;
  if (const auto* measured = find_measured(machine, lap.axis, run.feed)) {
    row.error.measured = row.error_quantised.measured = measured->error;
    row.current.measured = measured->current;
  }
  const auto& model = lap.friction.empty() ? run.friction : lap.friction;
  if (const auto* published = find_published(machine, lap.axis, model, run.feed)) {
    row.error.published = row.error_quantised.published = published->error;
    row.current.published = published->current;
    row.error_quantised.differs =
        std::abs(lap.peak_error_quantised - published->error) > 0.5 * increment_of(machine, lap.axis);
    row.current.differs = std::abs(lap.peak_current - published->current) > current_tolerance * published->current;
  }
  return row;
}

class Mean {
 public:
  void add(const std::optional<double>& value) {
    if (!value) return;
    sum_ += std::abs(*value);
    ++count_;
  }
  std::optional<double> value() const { return count_ ? std::optional(sum_ / count_) : std::nullopt; }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

}  // namespace

std::optional<double> ComparedFigure::deviation() const { return relative(measured, simulated); }

std::optional<double> ComparedFigure::published_deviation() const {
  return published ? relative(measured, *published) : std::nullopt;
}

std::vector<CircleTableRow> circle_table(const sim::CircleResult& result, const machine::Machine& machine) {
  std::vector<CircleTableRow> table;
  const std::size_t axes = result.runs.empty() ? 0 : result.runs.front().axes.size();
  for (std::size_t axis = 0; axis < axes; ++axis)
    for (const auto& run : result.runs) table.push_back(make_row(run, run.axes[axis], machine));
  return table;
}

std::vector<MeanDeviation> mean_deviations(const std::vector<CircleTableRow>& table) {
  std::vector<MeanDeviation> means;
  for (const auto& row : table) {
    const auto same = [&](const auto& other) { return other.axis == row.axis && other.friction == row.friction; };
    if (std::any_of(means.begin(), means.end(), same)) continue;
    Mean error, quantised, error_published, current, current_published;
    for (const auto& each : table) {
      if (!same(each)) continue;
      error.add(each.error.deviation());
      quantised.add(each.error_quantised.deviation());
      error_published.add(each.error.published_deviation());
      current.add(each.current.deviation());
      current_published.add(each.current.published_deviation());
    }
    means.push_back({row.axis, row.friction, error.value(), quantised.value(), error_published.value(), current.value(),
                     current_published.value()});
  }
  return means;
}

}  // namespace stiction::host
