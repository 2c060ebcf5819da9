// `stiction simulate circle` as a row of a sweep: one friction model, one feed, one direction.
#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/simulate/circle_plan.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/row_values.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {

std::vector<SweepFigure> sweep_circle(const SweepCommand& command, const SweepRow& row) {
  constexpr double micro = 1e6;  // m to um
  CirclePlan plan;
  plan.machine = machine_of(command, row);
  plan.signals = choice_option(row, "signals", {"fixed", "double"}) == "double" ? SignalKind::double_precision
                                                                                : SignalKind::fixed_point;
  plan.friction = {friction_option(row, plan.machine)};
  plan.directions = {choice_option(row, "direction", {"ccw", "cw"}) == "cw" ? sim::Direction::clockwise
                                                                            : sim::Direction::counter_clockwise};
  plan.radius = quantity_option(row, "radius", "m", usual_radius(plan.machine));
  plan.feeds = {quantity_option(row, "feed", "m/s", usual_feed(plan.machine, plan.radius))};
  const auto one = cases_of(plan).front();
  const auto run = plan.signals == SignalKind::fixed_point
                       ? run_circle<FixedSignals>(one.machine, one.settings)
                       : run_circle<machine::DoubleSignals>(one.machine, one.settings);
  std::vector<SweepFigure> figures;
  double largest = 0.0;
  for (std::size_t k = 0; k < run.axes.size(); ++k) {
    const auto& axis = run.axes[k];
    largest = std::max(largest, axis.peak_error);
    const auto effort = machine::effort_of(one.machine.axes[k].motor);
    figures.push_back({"peak_error_" + axis.axis, "um", axis.peak_error * micro});
    figures.push_back({"peak_error_quantised_" + axis.axis, "um", axis.peak_error_quantised * micro});
    figures.push_back({fmt::format("peak_{}_{}", effort.name, axis.axis), std::string(effort.unit), axis.peak_current});
  }
  figures.insert(figures.begin(), {"peak_error", "um", largest * micro});
  if (run.is_circle()) {
    figures.push_back({"circular_error", "um", run.errors.circular_error * micro});
    figures.push_back({"radial_error_max", "um", run.errors.radial_error_max * micro});
    figures.push_back({"radial_error_min", "um", run.errors.radial_error_min * micro});
  }
  return figures;
}

}  // namespace stiction::host
