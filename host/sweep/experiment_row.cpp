// The experiments of the table (host/simulate/experiments.hpp) as rows of a sweep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/machine_file.hpp"
#include "host/simulate/expected_figures.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/machine_needs.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/row_values.hpp"

namespace stiction::host {

std::vector<SweepFigure> sweep_figures(const sim::ExperimentResult& result) {
  std::vector<SweepFigure> figures;
  for (const auto& figure : result.figures) figures.push_back({name_without_model(figure), figure.unit, figure.value});
  return figures;
}

std::vector<SweepFigure> sweep_experiment(const SweepCommand& command, const SweepRow& row) {
  const auto table = experiments();
  const auto experiment =
      std::find_if(table.begin(), table.end(), [&](const Experiment& each) { return command.experiment == each.name; });
  ExperimentInput input{machine_of(command, row), {}};
  const auto& needs = needs_of(experiment->name);
  if (!needs.feed_drive) {
    const auto model = friction_option(row, input.machine);
    if (!needs.friction.empty() &&
        std::find(needs.friction.begin(), needs.friction.end(), model) == needs.friction.end())
      throw machine::MachineFileError(fmt::format("--friction: found '{}'; expected one that {} supports: {}", model,
                                                  experiment->name, fmt::join(needs.friction, ", ")));
    input.friction = {model};
  }
  if (experiment->feeds != nullptr) {
    input.feeds = quantity_list_option(row, "feed", "m/s");
    if (input.feeds.empty()) {
      SweepRow usual;
      usual.options = {{"feed", experiment->feeds}};
      input.feeds = quantity_list_option(usual, "feed", "m/s");
    }
    for (const double feed : input.feeds)
      if (!(feed > 0.0))
        throw machine::MachineFileError(
            fmt::format("--feed: found '{}'; expected feeds above zero", row.option("feed")));
  }
  input.equations = experiment->equations;
  if (!row.option("equations").empty()) {
    std::vector<std::string_view> known(experiment->equations.begin(), experiment->equations.end());
    input.equations = {choice_option(row, "equations", known)};
  }
  if (!row.option("jerk").empty()) {
    input.jerk = quantity_option(row, "jerk", "m/s^3", 0.0);
    if (!(*input.jerk > 0.0))
      throw machine::MachineFileError(
          fmt::format("--jerk: found '{}'; expected a jerk above zero", row.option("jerk")));
  }
  return sweep_figures(run_experiment(*experiment, input));
}

}  // namespace stiction::host
