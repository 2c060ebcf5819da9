#include "host/diagnose/behind_master.hpp"

#include <algorithm>

#include "host/diagnose/exact_records.hpp"
#include "host/diagnose/judge/command_residual.hpp"
#include "host/identify/identification.hpp"
#include "sim/effects/effects.hpp"
#include "sim/effects/master_delay/master_delay.hpp"

namespace stiction::host {

std::optional<DiagnoseInput> behind_master(const DiagnoseInput& input, const Prepared& prepared) {
  const auto &training = prepared.training, &held_out = prepared.held_out;
  const auto& axis = input.machine.axes[input.axis];
  const bool slave =
      std::ranges::all_of(training.logs, [&](const Log& log) { return !channels_of(log, axis).master.empty(); });
  if (!slave || !axis.cascaded() || (axis.elastic() && axis.velocity_encoder)) return std::nullopt;
  Verdict told;
  judge_command(told, input, {training.logs, training.rows, training.simulated},
                {held_out.logs, held_out.rows, held_out.simulated}, {},
                exact_logs(prepared, input, prepared.on_axis.parts_of(training.target).on_axis));
  const auto late = std::ranges::find_if(
      told.findings, [](const Finding& finding) { return sim::is_a<sim::MasterDelay>(finding.effect); });
  if (late == told.findings.end()) return std::nullopt;
  auto behind = input;
  auto& effects = behind.machine.axes[input.axis].effects;
  std::erase_if(effects, [](const machine::Effect& effect) { return sim::is_a<sim::MasterDelay>(effect); });
  effects.push_back(sim::effect_with(late->effect, {{"delay", late->values.at("delay")}}));
  return behind;
}

}  // namespace stiction::host
