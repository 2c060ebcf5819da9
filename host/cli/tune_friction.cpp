// `stiction tune-friction`: parameters of the friction compensation, and what it takes away.
#include <fmt/format.h>

#include <memory>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/logs.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/output/experiment_output.hpp"
#include "host/report/experiment_report.hpp"
#include "host/requests/tuning_options.hpp"
#include "host/tune/machine_tuning.hpp"
#include "host/tune/tuned_machine.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

struct TuneOptions {
  std::vector<std::string> logs;
  std::string columns;
  MachineOptions machine;
  std::string axis;
  std::string feed;
  std::string shown;
  std::string out;
  bool no_pulse = false;
  bool json = false;
};

TunedCompensations tune(const TuneOptions& options, const machine::Machine& machine, const std::vector<Log>& logs) {
  auto settings = tuning_settings({options.axis, options.feed, options.shown, options.no_pulse}, machine, logs);
  auto progress = std::make_unique<Progress>("tuning", settings.axes.size());
  settings.tuned = [&](const std::string& axis) { progress->add(axis); };
  settings.begin_comparison = [&](std::size_t circles) {
    progress.reset();  // its line is wiped before the next one appears
    progress = std::make_unique<Progress>("circles", circles);
  };
  settings.compared = [&] { progress->add(); };
  return tune_machine(machine, logs, settings);
}

void run(const TuneOptions& options, const Invocation& invocation) {
  const auto machine = options.machine.load(options.machine.machine, "");
  const auto logs = read_logs(options.logs, options.columns);
  const auto all = tune(options, machine, logs);
  const auto result = tuning_result(all);
  const auto json = experiment_json(result, all.machine);
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    auto sources = options.logs;
    if (sources.empty()) sources.emplace_back("circles of the simulated machine file");
    folder.write("tuned.toml", tuned_machine(machine::find_machine(options.machine.machine), options.machine.set, all,
                                             sources, invocation.command_line));
    sim::read_machine(folder.path() / "tuned.toml");  // what was written must be a machine
    folder.write("report.html", experiment_report_html({invocation.command_line, invocation.version, all.machine,
                                                        result, report_origin(options.machine.machine, logs)}));
    folder.write("result.json", json.dump(2) + "\n");
    folder.commit();
  }
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", experiment_text(result, all.machine));
  if (!options.out.empty()) fmt::print("\nmachine file: {0}/tuned.toml\nreport: {0}/report.html\n", options.out);
}

}  // namespace

void add_tune_friction(CLI::App& program, const Invocation& invocation) {
  auto* command = program.add_subcommand(
      "tune-friction", "tune the parameters of the friction compensation and compare before and after");
  auto o = std::make_shared<TuneOptions>();
  command
      ->add_option("logs", o->logs,
                   "logs of slow and fast circles without compensation, with position and current [simulations of the "
                   "machine file]")
      ->type_name("LOG");
  add_columns(*command, o->columns);
  o->machine.add_to(*command,
                    "shipped machine by name, or a machine file for drive and simulation, such as identified.toml");
  command->add_option("--axis", o->axis, "axis [all axes that every log has]")->type_name("NAME");
  command
      ->add_option("--feed", o->feed,
                   "feeds of the circles for the comparison, or of the sines of one axis [3.2 to 48 m/min, or slower "
                   "by one factor where the axes require it]")
      ->type_name("FEEDS");
  command
      ->add_option("--show", o->shown,
                   "feed of the charts, at which the speed pulse is tuned [16 m/min, or a third of the fastest feed]")
      ->type_name("FEED");
  command->add_flag("--no-pulse", o->no_pulse, "omit the speed pulse, whose tuning takes 500 simulated laps per axis");
  add_out(*command, o->out, "write tuned.toml, report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] { run(*o, invocation); });
}

}  // namespace stiction::host
