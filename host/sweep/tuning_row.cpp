// `stiction tune-friction` as a row of a sweep: on circles of the machine file's simulation.
#include "firmware/machine/file/machine_file.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/row_values.hpp"
#include "host/tune/machine_tuning.hpp"

namespace stiction::host {

std::vector<SweepFigure> sweep_tuning(const SweepCommand& command, const SweepRow& row) {
  const auto machine = machine_of(command, row);
  MachineTuningSettings settings;
  settings.axes = axes_option(row, machine);
  settings.feeds = quantity_list_option(row, "feed", "m/s");
  if (!row.option("show").empty()) settings.shown = quantity_option(row, "show", "m/s", 0.0);
  settings.pulse = row.option("no-pulse", "false") != "true";
  return sweep_figures(tuning_result(tune_machine(machine, {}, settings)));
}

}  // namespace stiction::host
