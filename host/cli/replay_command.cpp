#include "host/cli/replay_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

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
#include "host/requests/replay_request.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/replay_result.hpp"

namespace stiction::host {
namespace {

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
  std::optional<Progress> progress;
  const auto [log, cases, result] = replay_request(
      {split_list(options.machine.machine), options.from, options.columns, options.friction, options.axis,
       options.signals},
      {[&](const auto& name, const auto& needs) { return options.machine.load(name, "replay", needs); },
       [&](std::size_t runs) {
         if (!options.log.empty() && runs != 1)
           throw UsageError(fmt::format("--log: found {} runs; expected one machine and one friction model", runs));
         progress.emplace("simulating", 1 + runs);
       },
       [&](const auto& label) { progress->add(label); }});
  if (!options.log.empty()) keep(options.log, cases.front().simulated, options, cases.front());
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
