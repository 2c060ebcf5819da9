// `stiction cam shape`: the methods against residual vibration on one motion.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "host/cam/shape.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "host/cli/report_origin.hpp"
#include "host/output/experiment_output.hpp"
#include "host/report/experiment_report.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::host {
namespace {

struct ShapeOptions {
  MotionOptions motion;
  MachineOptions machine;
  std::string speed, method = "all", band = "20 %", wanted, out;
  bool json = false;
};

std::vector<const sim::cam::ShapingMethod*> methods_of(const std::string& text) {
  std::vector<std::string> names;
  std::vector<const sim::cam::ShapingMethod*> methods;
  for (const auto& method : sim::cam::shaping_methods()) names.emplace_back(method.name);
  for (const auto& name : text == "all" ? names : split_list(text)) {
    auto known = names;
    known.emplace_back("all");
    require_known("--method", name, "a method", known);
    if (const auto* method = sim::cam::find_shaping_method(name)) methods.push_back(method);
  }
  return methods;
}

// A share of the frequency: "20 %", or 0.2.
double band_of(const std::string& text) {
  const double band = cam_quantity("--band", text, "1", "a share of the frequency such as \"20 %\"");
  if (!(band > 0.0 && band <= 0.5))
    throw UsageError(fmt::format("--band: found '{}'; expected more than 0 and at most 50 %", text));
  return band;
}

// What the load's encoder can tell: two of its increments. Without one, a thousandth of the stroke.
double wanted_of(const ShapeOptions& options, const machine::AxisModel& axis, const sim::cam::ShapingTask& task) {
  const bool rotary = axis.coordinate.rotary();
  if (options.wanted.empty()) {
    if (axis.second_encoder && axis.second_encoder->increment > 0.0)
      return 2.0 * axis.second_encoder->increment / (rotary ? axis.coordinate.radius : 1.0);
    return 1e-3 * std::fabs(task.stroke);
  }
  const double wanted =
      cam_quantity("--wanted", options.wanted, rotary ? "rad" : "m", "what may be left, such as \"0.03 deg\"");
  if (!(wanted > 0.0)) throw UsageError(fmt::format("--wanted: found '{}'; expected more than 0", options.wanted));
  return wanted;
}

// A row a method; `o`: what it is shown in.
std::string table_text(const ShapingResult& shaping) {
  const bool turn = shaping.task.motion.cam.slave == sim::cam::Coordinate::rotary;
  const double slave = turn ? 180.0 / std::numbers::pi : 1e3;
  std::string text = fmt::format("{:<18}{:>12}{:>12}{:>12}{:>14}{:>12}\n", "method", "nominal", "over band", "running",
                                 "acceleration", turn ? "torque" : "force");
  text += fmt::format("{:<18}{:>12}{:>12}{:>12}{:>14}{:>12}\n", "", turn ? "deg" : "mm", turn ? "deg" : "mm",
                      turn ? "deg" : "mm", "of parabola", turn ? "N m" : "N");
  for (const auto& row : shaping.rows) {
    if (!row.made) {
      text += fmt::format("{:<18}{:>12}\n", row.method->name, "no room");
      continue;
    }
    const auto& made = *row.made;
    text += fmt::format("{:<18}{:>12.4f}{:>12.4f}{:>12.4f}{:>14.2f}{:>12.1f}{}\n", row.method->name,
                        made.from_rest.figures[made.from_rest.figures.size() / 2].peak_to_peak * slave,
                        made.from_rest.worst * slave, made.running.worst * slave, made.acceleration_ratio, row.torque,
                        row.broken.empty() ? "" : "  breaks a limit: " + row.broken);
  }
  return text;
}

void run_shape(const ShapeOptions& options, const Invocation& invocation) {
  const auto cam = options.motion.one();
  const auto methods = methods_of(options.method);
  auto machine = machine_of_cam(options.machine);
  const AxisLoad load = load_of_axis(options.machine, &cam);
  std::erase_if(machine.axes, [&](const auto& axis) { return axis.name != load.axis; });
  const auto& axis = machine.axes.front();
  const double speed = master_speed("--speed", options.speed, cam.master);
  ShapingResult shaping;
  try {
    auto task =
        shaping_task(sim::cam::compose(cam), sim::cam::elastic_drive_of(axis), speed, band_of(options.band), {});
    task.limits = limits_of(load, task.stroke, task.rise_time());
    shaping = shape(task, load, methods, wanted_of(options, axis, task));
  } catch (const sim::cam::StandError& error) {
    throw UsageError(fmt::format("--machine: {}", error.what()));
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("{}: {}", options.motion.motion, error.what()));
  }
  const auto result = shaping_report(shaping);
  const auto json = experiment_json(result, machine);
  if (!options.out.empty()) {
    PendingFolder folder(options.out, invocation.command);
    for (const auto& row : shaping.rows)
      if (row.made && row.broken.empty() && row.method != &sim::cam::shaping_methods().front())
        folder.write(std::string(row.method->name) + ".toml", sim::cam::motion_text({row.made->cam}));
    folder.write("report.html",
                 experiment_report_html({invocation.command_line, invocation.version, machine, result,
                                         report_origin(options.machine.machine, std::vector{options.motion.motion})}));
    folder.write("result.json", json.dump(2) + "\n");
    folder.commit();
  }
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n", table_text(shaping));
  for (const auto& finding : result.findings) fmt::print("{}\n", finding);
  if (!options.out.empty()) fmt::print("\nreport: {}/report.html\n", options.out);
}

}  // namespace

void add_cam_shape(CLI::App& cam, const Invocation& invocation) {
  auto* command =
      cam.add_subcommand("shape", "compare methods against residual vibration and write their motion files");
  auto o = std::make_shared<ShapeOptions>();
  o->motion.add_to(*command);
  o->machine.add_to(*command, "shipped machine by name, or a machine file, with an elastic axis that follows the cam");
  o->machine.add_axis_to(*command);
  command->add_option("--speed", o->speed, "speed of the master, such as \"130 rpm\"")->required()->type_name("SPEED");
  command->add_option("--method", o->method, "methods, separated by commas, or all of them [all]")
      ->type_name("METHODS");
  command->add_option("--band", o->band, "how far the frequency may be off [20 %]")->type_name("SHARE");
  command
      ->add_option("--wanted", o->wanted,
                   "what may be left from peak to peak, such as \"0.03 deg\" [two increments of the load's encoder]")
      ->type_name("LENGTH");
  add_out(*command, o->out, "write a motion file for each method, report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the figures as JSON on standard output");
  command->callback([o, &invocation] { run_shape(*o, invocation); });
}

}  // namespace stiction::host
