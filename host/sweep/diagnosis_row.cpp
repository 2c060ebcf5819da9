// `stiction diagnose` as a row of a sweep: one log, one axis.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "firmware/machine/file/machine_file.hpp"
#include "host/diagnose/diagnose.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"
#include "host/sweep/commands.hpp"
#include "host/sweep/row_values.hpp"
#include "sim/effects/effects.hpp"

namespace stiction::host {
namespace {

std::uint64_t seed_of(const SweepRow& row) {
  const auto text = row.option("seed", "1");
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    throw machine::MachineFileError(fmt::format("--seed: found '{}'; expected a whole number", text));
  return seed;
}

}  // namespace

std::vector<SweepFigure> sweep_diagnosis(const SweepCommand& command, const SweepRow& row) {
  DiagnoseInput input;
  input.machine = machine_of(command, row);
  for (const auto& file : row.logs)
    for (auto& stretch : stretches_of(read_log(file))) input.logs.push_back(std::move(stretch));
  const auto axes = axes_option(row, input.machine);
  if (axes.size() != 1)
    throw machine::MachineFileError(
        fmt::format("--axis: found none; expected the axis of {} to diagnose", input.machine.id));
  input.axis = axes.front();
  input.seed = seed_of(row);
  input.next_measurement = false;  // changes nothing of the findings
  const auto verdict = diagnose(input);
  const auto& force = verdict.units.force;
  std::vector<SweepFigure> figures{
      {"findings", "", static_cast<double>(named_causes(verdict.findings))},
      {std::string("baseline_") + verdict.units.force_word + "_rms", force.unit, force(verdict.baseline.force_rms)},
      {std::string("extended_") + verdict.units.force_word + "_rms", force.unit, force(verdict.extended.force_rms)},
      {"unexplained_share", "", verdict.unexplained.share}};
  // Of every effect, so that each row has the same columns: what it explains, 0 where it was not found, and its values.
  for (const auto& table : sim::effect_tables()) {
    const auto found = std::find_if(verdict.findings.begin(), verdict.findings.end(),
                                    [&](const Finding& each) { return each.effect.name() == table.name; });
    const bool named = found != verdict.findings.end();
    figures.push_back({fmt::format("explained_by_{}", table.name), "", named ? found->explains : 0.0});
    for (const auto& key : table.keys) {
      if (key.list) continue;
      const std::string unit(sim::key_unit(key, input.machine.axes[input.axis]));
      double value = std::numeric_limits<double>::quiet_NaN();
      if (named)
        for (const auto& parameter : found->parameters)
          if (parameter.key == key.key && !parameter.values.empty()) value = parameter.values.front();
      figures.push_back({fmt::format("{}_{}", table.name, key.key), unit == "1" ? "" : unit, value});
    }
  }
  return figures;
}

}  // namespace stiction::host
