// `stiction identify` as a row of a sweep: one log, one axis.
#include <algorithm>

#include "firmware/machine/file/machine_file.hpp"
#include "host/identify/law_choice.hpp"
#include "host/identify/own_identification.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/row_values.hpp"

namespace stiction::host {

std::vector<SweepFigure> sweep_identification(const SweepCommand& command, const SweepRow& row) {
  const auto machine = machine_of(command, row);
  const auto axes = axes_option(row, machine);
  if (axes.size() != 1)
    throw machine::MachineFileError("--axis: found none; expected the axis of " + machine.id + " to identify");
  const auto& axis = machine.axes[axes.front()];
  std::vector<Log> logs;
  for (const auto& file : row.logs)
    for (auto& stretch : stretches_of(read_log(file))) logs.push_back(std::move(stretch));
  IdentifyOptions options;
  options.friction = usual_law(axis);
  options.moving_rows_only = true;
  const auto result = in_own_units(identify_logs(linear_logs(logs, axis), axis, options), axis);
  std::vector<SweepFigure> figures;
  for (const auto& parameter : result.parameters) {
    // Names have their units, as in the command's JSON.
    figures.push_back({parameter.name, "", parameter.value});
    figures.push_back({parameter.name + "_low", "", parameter.ci95.low});
    figures.push_back({parameter.name + "_high", "", parameter.ci95.high});
  }
  return figures;
}

}  // namespace stiction::host
