// `stiction simulate cam`: a motion through the simulated axis.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "firmware/machine/configuration/double_signals.hpp"
#include "host/cam/duty.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/cam_stand.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/log/csv_log.hpp"
#include "host/output/experiment_output.hpp"
#include "host/simulate/cam_run_result.hpp"
#include "host/simulate/control_run.hpp"
#include "sim/cam/check.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

struct CamRunOptions {
  MachineOptions machine;
  MotionOptions motion;
  CamStandOptions stand;
  std::string speed, master = "ideal", log, out;
  int cycles = 3;
  bool json = false;
};

// Refuses a speed at which the axis cannot follow, with the place and the highest speed that works.
void require_limits(const sim::cam::Motion& motion, const AxisLoad& load, double speed, int cycles) {
  const Duty duty = duty_of(motion, load, speed);
  const bool rotary = motion.cam.master == sim::cam::Coordinate::rotary;
  for (const Limit& limit : duty.limits)
    if (limit.broken())
      throw UsageError(fmt::format(
          "--speed: found a {} of {:.5g} {} at {:.5g} {} of the master; expected at most {:.5g} {}, which a speed of "
          "up "
          "to {:.5g} {} keeps",
          limit.name, limit.found, limit.unit, rotary ? limit.place * 57.295779513082321 : limit.place * 1e3,
          rotary ? "°" : "mm", limit.allowed, limit.unit,
          rotary ? duty.highest_speed() * 9.5492965855137201 : duty.highest_speed(), rotary ? "rpm" : "m/s"));
  const double rise = std::fabs(motion.cam.position_of(motion.cam.segments.size()) - motion.cam.start);
  if (rise * (cycles + 1) > load.travel)
    throw UsageError(
        fmt::format("--cycles: found {} and one to start, each further on by {:.5g} {}; expected them within "
                    "the travel of {:.5g} {}",
                    cycles, rise, load.unit(), load.travel, load.unit()));
  for (const auto& found : jumps_of(motion))
    if (found.jump.order < 2)
      throw UsageError(fmt::format("--cam: found a jump of the {}; expected a motion that an axis can follow",
                                   sim::cam::derivative_name(found.jump.order)));
}

template <class S>
std::vector<CamRunCase> cam_cases(const machine::Machine& machine, const sim::cam::Motion& motion,
                                  CamRunSettings settings) {
  std::vector<CamRunCase> cases;
  const auto& axis = machine.axes.front();
  const bool compensates = axis.friction_compensation && axis.friction_compensation->use != CompensationKind::off;
  Progress progress("simulating", compensates ? 3 : 2);
  const auto add = [&](const char* name, const char* label) {
    cases.push_back({name, label, {}, {}});
    // A run with less than the machine file has may stop; its own must not.
    try {
      cases.back().run = run_cam<S>(machine, motion, settings);
    } catch (const FaultTripped& tripped) {
      if (cases.size() == 1) throw;
      cases.back().stopped = tripped.what();
    }
    progress.add(label);
  };
  if (compensates) add("compensated", "with feedforward and friction compensation");
  settings.compensation = false;
  add("feedforward", "with feedforward");
  settings.feedforward = false;
  add("plain", "without feedforward");
  return cases;
}

void run_cam_command(const CamRunOptions& options, const Invocation& invocation) {
  if (options.stand.asked())
    return run_cam_stand(
        options.stand,
        {options.machine, options.motion, options.speed, options.log, options.out, options.cycles, options.json},
        invocation);
  const auto cam = options.motion.one();
  const auto motion = sim::cam::compose(cam);
  const AxisLoad load = load_of_axis(options.machine, &cam);
  auto machine = options.machine.load(
      options.machine.machine, "",
      {.command = "cam", .rotary = true, .controllers = Controllers::known, .formats = Formats::or_doubles});
  std::erase_if(machine.axes, [&](const auto& axis) { return axis.name != load.axis; });
  CamRunSettings settings;
  settings.master_speed = master_speed("--speed", options.speed, cam.master);
  settings.cycles = options.cycles;
  settings.master = options.master == "noisy"   ? MasterSignal::noisy
                    : options.master == "steps" ? MasterSignal::steps
                                                : MasterSignal::ideal;
  require_limits(motion, load, settings.master_speed, settings.cycles);
  const bool fixed = machine.axes.front().cascaded() && machine.fits_formats();
  const auto cases = fixed ? cam_cases<FixedSignals>(machine, motion, settings)
                           : cam_cases<machine::DoubleSignals>(machine, motion, settings);
  const auto result =
      cam_run_result(motion, machine.axes.front(), fixed ? FixedSignals::name : machine::DoubleSignals::name, cases);
  const auto json = experiment_json(result, machine);
  if (!options.log.empty()) {
    PendingFile file(options.log);
    auto log = cases.front().run.log;
    log.comments = {{"made by", "stiction simulate cam"}, {"machine", machine.id}, {"cam", cam.name}};
    file.write(csv_log_text(log));
    file.commit();
  }
  write_experiment_folder(options.out, invocation, machine, result,
                          report_origin(options.machine.machine, std::vector{options.motion.motion}), json);
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
  o->stand.add_to(*command);
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
    if (o->motion.motion.empty() && !o->stand.verification) throw CLI::RequiredError("--cam");
    if (o->speed.empty() && !o->stand.verification) throw CLI::RequiredError("--speed");
    run_cam_command(*o, invocation);
  });
}

}  // namespace stiction::host
