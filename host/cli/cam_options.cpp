#include "host/cli/cam_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/units.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/motion_keys.hpp"

namespace stiction::host {
namespace {

std::vector<std::string> names_of(const std::vector<sim::cam::Cam>& cams) {
  std::vector<std::string> names;
  for (const auto& cam : cams) names.push_back(cam.name);
  return names;
}

const MachineNeeds& cam_needs() {
  static const MachineNeeds needs{
      .command = "cam", .rotary = true, .controllers = Controllers::any, .formats = Formats::any};
  return needs;
}

}  // namespace

void MotionOptions::add_to(CLI::App& command, bool several) {
  command.add_option("MOTION", motion, "motion file (stiction.cam/1)")->required()->type_name("MOTION");
  command.add_option("--cam", cam, several ? "name of one cam of the file [all]" : "name of the cam [the only one]")
      ->type_name("NAME");
}

std::vector<sim::cam::Cam> MotionOptions::cams() const {
  auto cams = sim::cam::read_motion_file(motion);
  if (cam.empty()) return cams;
  require_known("--cam", cam, "a cam of " + motion, names_of(cams));
  std::erase_if(cams, [&](const auto& each) { return each.name != cam; });
  return cams;
}

sim::cam::Cam MotionOptions::one() const {
  auto found = cams();
  if (found.size() != 1)
    throw UsageError(
        fmt::format("--cam: found none; expected a cam of {}: {}", motion, fmt::join(names_of(found), ", ")));
  return std::move(found.front());
}

double cam_quantity(const std::string& option, const std::string& text, std::string_view unit,
                    const std::string& example) {
  try {
    return machine::parse_quantity(text, unit);
  } catch (const machine::UnitError& error) {
    throw UsageError(fmt::format("{}: found '{}' ({}); expected {}", option, text, error.what(), example));
  }
}

double master_speed(const std::string& option, const std::string& text, sim::cam::Coordinate master) {
  const bool rotary = master == sim::cam::Coordinate::rotary;
  const std::string example = rotary ? "a speed of the master such as \"130 rpm\"" : "a speed such as \"0.5 m/s\"";
  const double speed = cam_quantity(option, text, rotary ? "rad/s" : "m/s", example);
  if (!(speed > 0.0)) throw UsageError(fmt::format("{}: found '{}'; expected more than 0", option, text));
  return speed;
}

machine::Machine machine_of_cam(const MachineOptions& options) {
  return options.load(options.machine, "", cam_needs());
}

AxisLoad load_of_axis(const MachineOptions& options, const sim::cam::Cam* cam) {
  const auto machine = machine_of_cam(options);
  const auto fits = [&](const machine::AxisModel& axis) {
    return cam == nullptr || axis.coordinate.rotary() == (cam->slave == sim::cam::Coordinate::rotary);
  };
  if (!options.axis.empty()) require_known("--axis", options.axis, "an axis of " + machine.id, axis_names(machine));
  for (const auto& axis : machine.axes) {
    if (!options.axis.empty() && axis.name != options.axis) continue;
    if (fits(axis)) return load_of(axis);
    if (options.axis.empty()) continue;
    throw UsageError(fmt::format("--axis: found {}, a {} axis; expected a {} one, as the slave of {} is", axis.name,
                                 axis.coordinate.rotary() ? "rotary" : "linear", name_of(cam->slave), cam->name));
  }
  throw UsageError(fmt::format("--machine: found {} without a {} axis; expected one that the cam {} can drive",
                               machine.id, name_of(cam->slave), cam->name));
}

std::vector<std::string> cam_tasks() {
  std::vector<std::string> tasks;
  for (const auto& law : sim::cam::laws())
    if (std::find(tasks.begin(), tasks.end(), task_of(law)) == tasks.end()) tasks.push_back(task_of(law));
  std::sort(tasks.begin(), tasks.end());
  return tasks;
}

}  // namespace stiction::host
