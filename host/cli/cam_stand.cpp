#include "host/cli/cam_stand.hpp"

#include <fmt/format.h>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/output.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/simulate/stand_result.hpp"
#include "host/simulate/stand_run.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

struct StandSimulation {
  const machine::Machine& machine;
  const sim::cam::Motion& motion;
  double speed;
  int cycles;
  Log log{};
  std::string signals{};
};

StandCase simulated(const std::string& model, StandSimulation& s) {
  const auto drive = sim::cam::elastic_drive_of(s.machine.axes.front());
  const sim::cam::ResponseSettings settings{.master_speed = s.speed, .cycles = s.cycles, .step = 0.1e-3};
  if (model == "transfer-function")
    return {model, "by the transfer function", transfer_response(drive, s.motion, settings)};
  if (model == "lagrange") return {model, "by Lagrange's equations", lagrange_response(drive, s.motion, settings)};
  const StandSettings run{.master_speed = s.speed, .cycles = s.cycles};
  const bool fixed = s.machine.fits_formats();
  auto done = fixed ? run_stand<FixedSignals>(s.machine, s.motion, run)
                    : run_stand<machine::DoubleSignals>(s.machine, s.motion, run);
  s.log = std::move(done.log);
  s.signals = fixed ? FixedSignals::name : machine::DoubleSignals::name;
  return {model, "by the firmware's cascade", std::move(done.load)};
}

}  // namespace

void CamStandOptions::add_to(CLI::App& command) {
  command
      .add_option("--model", model,
                  "the load on an elastic axis in place of the following error, by these models, separated by commas: "
                  "cascade, transfer-function, lagrange")
      ->type_name("MODELS");
  command.add_flag("--verification", verification,
                   "the case with which Dostrasil 2014 checks the model, in place of --cam and --speed");
}

void run_cam_stand(const CamStandOptions& options, const CamStandRun& run, const Invocation& invocation) {
  std::vector<std::string> models = split_list(options.model.empty() ? "transfer-function, lagrange" : options.model);
  for (const auto& model : models) require_known("--model", model, "a model", stand_models());
  if (options.verification && (!run.motion.motion.empty() || !run.speed.empty()))
    throw UsageError("--verification: found it with --cam or --speed; expected one of them, since it has its own");
  const auto cam = options.verification ? verification_cam() : run.motion.one();
  const double speed = options.verification ? verification_speed : master_speed("--speed", run.speed, cam.master);
  const auto motion = sim::cam::compose(cam);
  auto machine = run.machine.load(
      run.machine.machine, "",
      {.command = "cam", .rotary = true, .controllers = Controllers::known, .formats = Formats::or_doubles});
  const auto axis = load_of_axis(run.machine, &cam).axis;
  std::erase_if(machine.axes, [&](const auto& each) { return each.name != axis; });
  StandSimulation simulation{machine, motion, speed, options.verification ? 1 : run.cycles};
  std::vector<StandCase> cases;
  try {
    for (const auto& model : models) cases.push_back(simulated(model, simulation));
  } catch (const sim::cam::StandError& error) {
    throw UsageError(fmt::format("--model: {}", error.what()));
  }
  auto result = stand_result(motion, speed, cases, simulation.signals);
  if (options.verification)
    result.findings.emplace_back(
        "The transfer function that Dostrasil 2014 prints has the denominator of Lagrange's equations; its numerator "
        "lacks "
        "the gear's 1/33, so that it holds for set-points at the output alone. The corrected one is used here.");
  const auto json = experiment_json(result, machine);
  if (!run.log.empty()) {
    if (simulation.log.t.empty()) throw UsageError("--log: found no model cascade; expected it, which records one");
    PendingFile file(run.log);
    simulation.log.comments = {{"made by", "stiction simulate cam"}, {"machine", machine.id}, {"cam", cam.name}};
    file.write(csv_log_text(simulation.log));
    file.commit();
  }
  const auto sources = options.verification ? std::vector<std::string>{} : std::vector<std::string>{run.motion.motion};
  write_experiment_folder(run.out, invocation, machine, result, report_origin(run.machine.machine, sources), json);
  if (run.json)
    fmt::print("{}\n", json.dump(2));
  else
    print_experiment(result, machine, written(run.log), run.out);
}

}  // namespace stiction::host
