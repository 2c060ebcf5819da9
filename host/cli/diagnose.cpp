// `stiction diagnose`: what the simulation of an axis gets wrong, from measured logs.
#include "host/diagnose/diagnose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/diagnose_output.hpp"
#include "host/cli/diagnose_reference.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"

namespace stiction::host {
namespace {

struct DiagnoseCommandOptions {
  std::vector<std::string> logs, held_out;
  MachineOptions machine;
  std::string reference;  // instead of logs
  std::string axis;
  std::string columns;
  std::string out;
  std::uint64_t seed = 1;
  bool json = false;
};

std::size_t axis_of_run(const std::string& name, const machine::Machine& machine, const std::vector<Log>& logs) {
  const auto names = axis_names(machine);
  if (!name.empty()) require_known("--axis", name, "an axis of " + machine.id, names);
  std::vector<std::size_t> fitting;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!name.empty() && names[k] == name) return k;
    if (std::all_of(logs.begin(), logs.end(), [&](const Log& log) {
          return std::any_of(log.axes.begin(), log.axes.end(),
                             [&](const AxisLog& c) { return c.axis.empty() || c.axis == names[k]; });
        }))
      fitting.push_back(k);
  }
  if (name.empty() && fitting.size() == 1) return fitting.front();
  throw UsageError(fmt::format("--axis: found none, but the logs have channels of {} axes of {}; expected one of {}",
                               fitting.size(), machine.id, fmt::join(names, ", ")));
}

void run(const DiagnoseCommandOptions& options, const Invocation& invocation) {
  DiagnoseInput input;
  input.machine = options.machine.load(options.machine.machine, "");
  input.logs = read_logs(options.logs, options.columns);
  input.held_out = read_logs(options.held_out, options.columns);
  auto all = input.logs;
  all.insert(all.end(), input.held_out.begin(), input.held_out.end());
  input.axis = axis_of_run(options.axis, input.machine, all);
  input.seed = options.seed;
  Verdict verdict;
  {
    Progress progress("diagnosis", diagnosis_parts.size());
    input.progress = [&](std::string_view part) { progress.add(part); };
    verdict = diagnose(input);
    input.progress = {};
  }
  put_out(verdict, input.machine, options.machine, options.out, options.json, invocation,
          report_origin(options.machine.machine, all));
}

}  // namespace

void add_diagnose(CLI::App& program, const Invocation& invocation) {
  auto* command =
      program.add_subcommand("diagnose", "find causes of deviations between measured logs and the machine file");
  auto o = std::make_shared<DiagnoseCommandOptions>();
  command->add_option("logs", o->logs, "logs of one axis to search for causes (training data)")->type_name("LOG");
  add_columns(*command, o->columns);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, with which the logs are compared");
  command
      ->add_option("--holdout", o->held_out,
                   "logs of different trajectories for validation [the last third of each LOG]")
      ->type_name("LOG");
  command->add_option("--reference", o->reference, "use the measured rows of the machine file instead of logs")
      ->check(one_of({"circle"}));
  command->add_option("--axis", o->axis, "axis to diagnose, if logs and machine have several")->type_name("NAME");
  command->add_option("--seed", o->seed, "seed of the bootstrap for intervals on held-out data")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str();
  add_out(*command, o->out, "write verdict.json, extended.toml, report.html and next_measurement.csv into this folder");
  command->add_flag("--json", o->json, "print the verdict as JSON on standard output");
  command->callback([o, &invocation] {
    try {
      if (!o->reference.empty()) {
        if (!o->logs.empty() || !o->held_out.empty() || !o->axis.empty())
          throw UsageError("--reference: found it together with LOG, --holdout or --axis; expected it alone");
        diagnose_from_reference({o->machine, o->reference, o->out, o->json}, invocation);
        return;
      }
      if (o->logs.empty()) throw UsageError("diagnose: found no LOG; expected at least one, or --reference circle");
      run(*o, invocation);
    } catch (const LogError& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace stiction::host
