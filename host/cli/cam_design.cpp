// `stiction cam rank` and `stiction cam design`: a law for a stroke on an axis, and the page of a motion on one.
#include <fmt/format.h>

#include <memory>

#include "host/cam/design.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/cam_output.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/output.hpp"
#include "host/cli/report_origin.hpp"
#include "host/output/experiment_output.hpp"

namespace stiction::host {
namespace {

struct RankOptions {
  MachineOptions machine;
  std::string stroke, rise, speed, band, task = "R-R";
  bool json = false;
};

void read_band(const RankOptions& options, const AxisLoad& load, RankTask& task) {
  const auto usual = usual_band(load, task.rise / task.master_speed);
  task.lowest = usual.lowest, task.highest = usual.highest;
  if (options.band.empty()) return;
  const auto parts = split_list(options.band);
  const std::string example = "two frequencies such as \"8 Hz, 12 Hz\"";
  if (parts.size() != 2)
    throw UsageError(fmt::format("--band: found {} frequencies; expected {}", parts.size(), example));
  task.lowest = cam_quantity("--band", parts[0], "Hz", example);
  task.highest = cam_quantity("--band", parts[1], "Hz", example);
  if (!(task.lowest > 0.0 && task.highest >= task.lowest))
    throw UsageError(fmt::format("--band: found '{}'; expected rising frequencies above 0", options.band));
}

void run_rank(const RankOptions& options) {
  const AxisLoad load = load_of_axis(options.machine, nullptr);
  RankTask task;
  task.task = options.task;
  const bool rotary = load.kind == sim::cam::Coordinate::rotary;
  task.stroke = cam_quantity("--stroke", options.stroke, rotary ? "rad" : "m",
                             rotary ? "an angle of the axis such as \"90 deg\"" : "a length such as \"40 mm\"");
  task.rise = cam_quantity("--rise", options.rise, "rad", "an angle of the master such as \"180 deg\"");
  task.master_speed = master_speed("--speed", options.speed, sim::cam::Coordinate::rotary);
  if (!(task.rise > 0.0) || task.stroke == 0.0)
    throw UsageError("--stroke, --rise: found 0; expected a stroke, and a rise above 0");
  read_band(options, load, task);
  const auto ranking = rank_laws(task, load);
  if (options.json)
    fmt::print("{}\n", rank_json(ranking, task, load).dump(2));
  else
    fmt::print("{}", rank_text(ranking, task, load));
}

void add_rank_options(CLI::App& cam) {
  auto* command = cam.add_subcommand("rank", "compare all laws for one stroke on an axis and recommend one");
  auto o = std::make_shared<RankOptions>();
  command->add_option("--stroke", o->stroke, "what the axis moves by, such as \"90 deg\" or \"40 mm\"")
      ->required()
      ->type_name("STROKE");
  command->add_option("--rise", o->rise, "angle of the master for it, such as \"180 deg\"")
      ->required()
      ->type_name("ANGLE");
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\"")->required()->type_name("SPEED");
  o->machine.add_to(*command, "shipped machine by name, or a machine file, whose axis moves");
  o->machine.add_axis_to(*command);
  command
      ->add_option("--band", o->band,
                   "natural frequencies for the residual oscillation, such as \"8 Hz, 12 Hz\" [20 % around the elastic "
                   "axis' own, or 1 to 5 periods in the rise]")
      ->type_name("BAND");
  auto tasks = cam_tasks();
  tasks.emplace_back(every_task);
  command->add_option("--task", o->task, "task of VDI 2143, or all of them with the rise-return laws [R-R]")
      ->check(one_of(tasks))
      ->type_name("TASK");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o] { run_rank(*o); });
}

struct DesignOptions {
  MotionOptions motion;
  MachineOptions machine;
  std::string speed, out;
  bool json = false;
};

void run_design(const DesignOptions& options, const Invocation& invocation) {
  const auto cam = options.motion.one();
  const auto machine = machine_of_cam(options.machine);
  const double speed = master_speed("--speed", options.speed, cam.master);
  CamDesign design{sim::cam::compose(cam), {}, load_of_axis(options.machine, &cam), {}};
  design.jumps = jumps_of(design.motion);
  design.duty = duty_of(design.motion, design.load, speed);
  const auto result = design_result(design);
  const auto json = experiment_json(result, machine);
  write_experiment_folder(options.out, invocation, machine, result,
                          report_origin(options.machine.machine, std::vector{options.motion.motion}), json);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_experiment(result, machine, {}, options.out);
}

}  // namespace

void add_cam_rank(CLI::App& cam) { add_rank_options(cam); }

void add_cam_design(CLI::App& cam, const Invocation& invocation) {
  auto* command =
      cam.add_subcommand("design", "show a motion on an axis: curves, torque, spectrum, residual oscillation");
  auto o = std::make_shared<DesignOptions>();
  o->motion.add_to(*command);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, that follows the cam");
  o->machine.add_axis_to(*command);
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\" or \"0.5 m/s\"")
      ->required()
      ->type_name("SPEED");
  add_out(*command, o->out, "write report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] { run_design(*o, invocation); });
}

}  // namespace stiction::host
