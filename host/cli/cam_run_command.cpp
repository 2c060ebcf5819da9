// `stiction simulate cam`: a motion through the simulated axis.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "host/cli/cam_options.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/requests/cam_run_request.hpp"

namespace stiction::host {
namespace {

struct CamRunOptions {
  MachineOptions machine;
  MotionOptions motion;
  std::string speed, master = "ideal", model, log, out;
  int cycles = 3;
  bool verification = false, json = false;
};

void run_cam_command(const CamRunOptions& options, const Invocation& invocation) {
  std::optional<Progress> progress;
  auto [machine, cam, result, logs] =
      cam_run_request({options.motion.motion, options.motion.cam, options.speed, options.machine.axis, options.master,
                       options.cycles, options.model, options.verification},
                      {[&](const auto& needs) { return options.machine.load(options.machine.machine, "", needs); },
                       [&](std::size_t runs) { progress.emplace("simulating", runs); },
                       [&](const auto& label) { progress->add(label); }});
  progress.reset();
  const auto json = experiment_json(result, machine);
  if (!options.log.empty()) {
    if (logs.empty()) throw UsageError("--log: found no model cascade; expected it, which records one");
    PendingFile file(options.log);
    auto& log = logs.front().log;
    log.comments = {{"made by", "stiction simulate cam"}, {"machine", machine.id}, {"cam", cam}};
    file.write(csv_log_text(log));
    file.commit();
  }
  const auto sources = options.motion.motion.empty() ? std::vector<std::string>{} : std::vector{options.motion.motion};
  write_experiment_folder(options.out, invocation, machine, result, report_origin(options.machine.machine, sources),
                          json);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_experiment(result, machine, written(options.log), options.out);
}

}  // namespace

void add_cam_run(CLI::App& simulate, const Invocation& invocation) {
  auto* command =
      simulate.add_subcommand("cam", "simulate the drive's electronic cam: following error, torque, power, energy");
  auto o = std::make_shared<CamRunOptions>();
  o->machine.add_to(*command, "shipped machine by name, or a machine file, whose axis follows the cam");
  o->machine.add_axis_to(*command);
  command->add_option("--cam", o->motion.motion, "motion file (stiction.cam/1)")->type_name("MOTION");
  command->add_option("--name", o->motion.cam, "name of the cam in the file [the only one]")->type_name("NAME");
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\" or \"0.5 m/s\"")
      ->type_name("SPEED");
  command
      ->add_option("--model", o->model,
                   "the load on an elastic axis in place of the following error, by these models, separated by commas: "
                   "cascade, transfer-function, lagrange")
      ->type_name("MODELS");
  command->add_flag("--verification", o->verification,
                    "the case with which Dostrasil 2014 checks the model, in place of --cam and --speed");
  command->add_option("--cycles", o->cycles, "measured cycles, after the one in which the master starts [3]")
      ->check(whole_number_between(1, 1000))
      ->type_name("N");
  command
      ->add_option(
          "--master", o->master,
          "what the slave knows of the master: ideal; noisy, a position with noise of 10 ppm of a cycle; steps, "
          "an encoder of 10000 steps in a cycle; the last two through the drive's estimator [ideal]")
      ->check(one_of({"ideal", "noisy", "steps"}))
      ->type_name("SIGNAL");
  add_output_file(*command, "--log", o->log, "write the measured cycles of the first run as a log");
  add_out(*command, o->out, "write report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] {
    // Both are needed but for the case of --verification.
    if (o->motion.motion.empty() && !o->verification) throw CLI::RequiredError("--cam");
    if (o->speed.empty() && !o->verification) throw CLI::RequiredError("--speed");
    run_cam_command(*o, invocation);
  });
}

}  // namespace stiction::host
