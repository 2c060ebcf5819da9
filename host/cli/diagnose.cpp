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
#include "host/cli/diagnose_start.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/requests/axis_choice.hpp"

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
  bool identify = false;
  bool json = false;
};

std::string start_sentence(const std::vector<StartValue>& values) {
  std::vector<std::string> all;
  for (const auto& each : values) all.push_back(fmt::format("{} = {:.4g}", each.name, each.value));
  return fmt::format(
      "The diagnosis starts from values that were identified from the training logs ({}); extended.toml contains them.",
      fmt::join(all, ", "));
}

Verdict diagnose_axis(DiagnoseInput& input, DiagnosedFile& file, const IntermediateFolder& folder, bool identify,
                      const Invocation& invocation) {
  if (!identify) return diagnose(input);
  const auto values = start_from_identified(input, file, folder, invocation.command_line);
  auto verdict = diagnose(input);
  verdict.identified = values;
  verdict.notes.insert(verdict.notes.begin(), start_sentence(values));
  return verdict;
}

void run(const DiagnoseCommandOptions& options, const Invocation& invocation) {
  DiagnoseInput input;
  input.machine = options.machine.load(options.machine.machine, "", needs_of("diagnose"));
  input.logs = read_logs(options.logs, options.columns);
  input.held_out = read_logs(options.held_out, options.columns);
  auto all = input.logs;
  all.insert(all.end(), input.held_out.begin(), input.held_out.end());
  const auto axes = axes_to_diagnose(options.axis, input.machine, all);
  input.seed = options.seed;
  DiagnosedFile file{machine::find_machine(options.machine.machine), options.machine.set};
  const IntermediateFolder folder;
  std::vector<Verdict> verdicts;
  {
    Progress progress("diagnosis", axes.size() * diagnosis_parts.size());
    for (const auto axis : axes) {
      input.axis = axis;
      const auto of = axes.size() > 1 ? input.machine.axes[axis].name + ": " : std::string();
      input.progress = [&](std::string_view part) { progress.add(of + std::string(part)); };
      verdicts.push_back(diagnose_axis(input, file, folder, options.identify, invocation));
    }
  }
  put_out(verdicts, input.machine, file, options.out, options.json, invocation,
          report_origin(options.machine.machine, all));
}

}  // namespace

void add_diagnose(CLI::App& program, const Invocation& invocation) {
  auto* command =
      program.add_subcommand("diagnose", "find causes of deviations between measured logs and the machine file");
  auto o = std::make_shared<DiagnoseCommandOptions>();
  command->add_option("logs", o->logs, "logs to search for causes (training data)")->type_name("LOG");
  add_columns(*command, o->columns);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, with which the logs are compared");
  command
      ->add_option("--holdout", o->held_out,
                   "logs of different trajectories for validation [the last third of each LOG]")
      ->type_name("LOG");
  command->add_option("--reference", o->reference, "use the measured rows of the machine file instead of logs")
      ->check(one_of({"circle"}));
  command->add_flag("--identify", o->identify,
                    "identify mass and friction from the training logs first, for a machine file that was never "
                    "identified; the file with these values is diagnosed");
  command->add_option("--axis", o->axis, "axis to diagnose [each that logs and machine share]")->type_name("NAME");
  command->add_option("--seed", o->seed, "seed of the bootstrap for intervals on held-out data")
      ->check(whole_number())
      ->type_name("N")
      ->capture_default_str();
  add_out(*command, o->out,
          "write verdict.json, extended.toml, report.html, next_measurement.csv and, of a cam, "
          "next_measurement_cam.toml into this folder");
  command->add_flag("--json", o->json, "print the verdict as JSON on standard output");
  command->callback([o, &invocation] {
    try {
      if (!o->reference.empty()) {
        if (!o->logs.empty() || !o->held_out.empty() || !o->axis.empty() || o->identify)
          throw UsageError(
              "--reference: found it together with LOG, --holdout, --identify or --axis; expected it alone");
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
