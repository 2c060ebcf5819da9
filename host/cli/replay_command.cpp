#include "host/cli/replay_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/log/mat_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/replay.hpp"
#include "host/simulate/replay_result.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

std::vector<ReplayCase> cases_of(const ReplayOptions& options) {
  std::vector<ReplayCase> cases;
  const auto names = split_list(options.machine.machine);
  auto needs = needs_of("replay");
  // The limits of the number formats are the firmware's alone.
  if (options.signals == "double") needs.formats = Formats::any;
  for (const auto& name : names) {
    const auto machine = options.machine.load(name, "replay", needs);
    const auto models = friction_models(options.friction, machine);
    for (const auto& friction : models) {
      const auto label = names.size() == 1    ? friction
                         : models.size() == 1 ? machine.id
                                              : fmt::format("{}, {}", machine.id, friction);
      for (const auto& other : cases)
        if (other.label == label)
          throw UsageError(fmt::format("--machine, --friction: found {} twice; expected different names", label));
      auto& c = cases.emplace_back(ReplayCase{label, machine, {}});
      use_friction(c.machine, friction);
      // Machines have colours of their own, and so have axes with laws of their own.
      if (label != machine.id && machine.axes.front().friction.models.contains(friction)) c.friction = friction;
    }
  }
  return cases;
}

void keep(const std::filesystem::path& file, Log simulated, const ReplayOptions& options, const ReplayCase& c) {
  simulated.comments = {{"made by", "stiction simulate replay"},
                        {"machine", c.machine.id},
                        {"friction", friction_in_use(c.machine)},
                        {"from", options.from}};
  PendingFile pending(file);
  if (file.extension() == ".mat")
    pending.fill([&](const auto& path) { write_mat_log(path, simulated); });
  else
    pending.write(csv_log_text(simulated));
  pending.commit();
}

}  // namespace

void run_replay(const ReplayOptions& options, const Invocation& invocation, const ReplayJson& json_of) {
  auto cases = cases_of(options);
  if (!options.log.empty() && cases.size() != 1)
    throw UsageError(fmt::format("--log: found {} runs; expected one machine and one friction model", cases.size()));
  auto progress = std::make_optional<Progress>("simulating", 1 + cases.size());
  const auto log = read_log(options.from, {options.columns, {}});
  // A controller that is not the firmware's has doubles alone.
  const bool fixed = options.signals != "double" && std::all_of(cases.begin(), cases.end(), [](const ReplayCase& c) {
                       return std::all_of(c.machine.axes.begin(), c.machine.axes.end(),
                                          [](const machine::AxisModel& axis) { return axis.cascaded(); });
                     });
  for (auto& c : cases) {
    progress->add(c.label);
    c.simulated = fixed ? replay<FixedSignals>(c.machine, log, {options.axis})
                        : replay<machine::DoubleSignals>(c.machine, log, {options.axis});
  }
  if (!options.log.empty()) keep(options.log, cases.front().simulated, options, cases.front());
  const auto result =
      replay_result(log, cases, fixed ? FixedSignals::name : machine::DoubleSignals::name, options.axis);
  const auto& machine = cases.front().machine;
  const auto json = json_of ? json_of(log, cases, result) : experiment_json(result, machine);
  write_experiment_folder(options.out, invocation, machine, result,
                          report_origin(options.machine.machine, std::vector{log}), json);
  progress.reset();
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_experiment(result, machine, written(options.log), options.out);
}

void add_replay(CLI::App& simulate, const Invocation& invocation) {
  auto* command =
      simulate.add_subcommand("replay", "simulate the set-points of a log and compare with the measured signals");
  auto o = std::make_shared<ReplayOptions>();
  command->add_option("--from", o->from, "log with the channel x_set")->required()->type_name("LOG");
  add_columns(*command, o->columns);
  o->machine.add_to(*command, "shipped machine by name, or a machine file");
  command->add_option("--friction", o->friction, "friction model, list of models, or all [as in the machine file]")
      ->type_name("MODEL");
  command->add_option("--axis", o->axis, "axis of the machine, for a log without axis names")->type_name("AXIS");
  command
      ->add_option("--signals", o->signals,
                   "fixed: the firmware in fixed point; double: the same laws in double precision")
      ->check(one_of({"fixed", "double"}))
      ->capture_default_str();
  add_output_file(*command, "--log", o->log,
                  "write the simulated channels at the times of the log (NAME.csv or NAME.mat)");
  add_out(*command, o->out, "write report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] { run_replay(*o, invocation); });
}

}  // namespace stiction::host
