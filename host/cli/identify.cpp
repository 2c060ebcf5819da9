// `stiction identify`: mass and friction of an axis from measured logs, or from a table of steady states.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/identify_reference.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/identify/identified_machine.hpp"
#include "host/identify/own_identification.hpp"
#include "host/output/identify_output.hpp"
#include "host/report/identification_report.hpp"
#include "host/requests/identify_request.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct IdentifyCommandOptions {
  std::vector<std::string> logs;
  std::string columns;
  std::string reference;
  MachineOptions machine;
  std::string axis;
  std::string friction;
  std::string amperes;
  std::vector<std::string> fix;
  std::string out;
  bool refine = false;
  bool json = false;
};

void run(const IdentifyCommandOptions& options, const Invocation& invocation) {
  const auto machine = options.machine.load(options.machine.machine, "", needs_of("identify"));
  const auto file = machine::find_machine(options.machine.machine);
  std::optional<Progress> progress;
  const auto identified = identify_request(
      {options.logs, options.columns, options.axis, options.friction, options.amperes, options.fix, options.refine},
      machine, {read_logs, [&] { progress.emplace(options.refine ? "identifying and refining" : "identifying"); }});
  progress.reset();
  const auto& [axis, linear, logs] = identified;
  const auto origin = logs.empty() ? report_origin(options.machine.machine, options.logs)
                                   : report_origin(options.machine.machine, logs);
  const auto result = in_own_units(linear, *axis);
  const auto json = identification_json(result);
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    folder.write("identified.toml",
                 identified_machine(file, options.machine.set, *axis, linear, invocation.command_line));
    sim::read_machine(folder.path() / "identified.toml");  // what was written must be a machine
    folder.write("report.html",
                 identification_report_html({invocation.command_line, invocation.version, machine, result, origin}));
    folder.write("result.json", json.dump(2) + "\n");
    folder.commit();
  }
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", identification_text(result));
  if (!options.out.empty()) fmt::print("\nmachine file: {0}/identified.toml\nreport: {0}/report.html\n", options.out);
}

}  // namespace

void add_identify(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand("identify", "identify mass and friction from measured logs");
  auto o = std::make_shared<IdentifyCommandOptions>();
  auto* logs =
      command->add_option("logs", o->logs, "logs of one axis, or one table of steady states (columns v[m/min],i[A])")
          ->type_name("LOG");
  add_columns(*command, o->columns);
  command
      ->add_option("--reference", o->reference,
                   "use the measured rows of this experiment in the machine file instead of logs")
      ->excludes(logs)
      ->check(one_of({"circle"}));
  o->machine.add_to(*command,
                    "shipped machine by name, or a machine file with force constant, limits and friction models");
  command->add_option("--axis", o->axis, "axis to identify, if logs and machine have several")->type_name("NAME");
  command
      ->add_option("--friction", o->friction,
                   "coulomb_viscous: sgn(v) of every sample, as published for EMPS; lugre: with presliding; or the "
                   "law in use, if its contact has one length (dahl, elasto_plastic) "
                   "[for a law of the file that sticks rigidly sgn(v) of the moving rows; else the law in use, if its "
                   "contact has one length; else lugre]")
      ->type_name("MODEL");
  command
      ->add_option("--amperes", o->amperes,
                   "convention of the currents [logs: peak; a table needs this option or a comment]")
      ->check(one_of({"peak", "rms"}));
  command
      ->add_option("--fix", o->fix,
                   "hold mass, viscous, coulomb or constant_force (of a rotary axis inertia, gravity or "
                   "constant_torque) at this value instead of estimating it, for example "
                   "mass=225kg; may be given several times")
      ->type_name("KEY=VALUE");
  command->add_flag("--refine", o->refine,
                    "refine mass, friction and stiffness in closed-loop simulation with the set-points of the logs; "
                    "takes seconds, and helps if the position is noisy or coarse");
  add_out(*command, o->out, "write identified.toml, report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] {
    try {
      if (!o->reference.empty()) return identify_reference({o->machine, o->reference, o->out, o->json}, invocation);
      if (o->logs.empty()) throw UsageError("identify: found neither LOG nor --reference; expected one of them");
      run(*o, invocation);
    } catch (const LogError& error) {
      throw UsageError(error.what());
    }
  });
}

}  // namespace stiction::host
