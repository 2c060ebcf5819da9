#include "host/requests/cam_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/units.hpp"
#include "host/requests/names.hpp"
#include "host/requests/usage_error.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/motion_keys.hpp"

namespace stiction::host {
namespace {

std::vector<std::string> cam_names(const std::vector<sim::cam::Cam>& cams) {
  std::vector<std::string> names;
  for (const auto& cam : cams) names.push_back(cam.name);
  return names;
}

}  // namespace

const MachineNeeds& cam_needs() {
  static const MachineNeeds needs{
      .command = "cam", .rotary = true, .controllers = Controllers::any, .formats = Formats::any};
  return needs;
}

std::vector<sim::cam::Cam> cams_of(const std::string& file, const std::string& name, const std::string& option) {
  auto cams = sim::cam::read_motion_file(file);
  if (name.empty()) return cams;
  require_known(option, name, "a cam of " + file, cam_names(cams));
  std::erase_if(cams, [&](const auto& each) { return each.name != name; });
  return cams;
}

sim::cam::Cam one_cam(const std::string& file, const std::string& name, const std::string& option) {
  auto found = cams_of(file, name, option);
  if (found.size() != 1)
    throw UsageError(
        fmt::format("{}: found none; expected a cam of {}: {}", option, file, fmt::join(cam_names(found), ", ")));
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

AxisLoad axis_of_cam(const machine::Machine& machine, const std::string& name, const sim::cam::Cam* cam) {
  const auto fits = [&](const machine::AxisModel& axis) {
    return cam == nullptr || axis.coordinate.rotary() == (cam->slave == sim::cam::Coordinate::rotary);
  };
  if (!name.empty()) require_known("--axis", name, "an axis of " + machine.id, axis_names(machine));
  for (const auto& axis : machine.axes) {
    if (!name.empty() && axis.name != name) continue;
    if (fits(axis)) return load_of(axis);
    if (name.empty()) continue;
    throw UsageError(fmt::format("--axis: found {}, a {} axis; expected a {} one, as the slave of {} is", axis.name,
                                 axis.coordinate.rotary() ? "rotary" : "linear", name_of(cam->slave), cam->name));
  }
  throw UsageError(fmt::format("--machine: found {} without a {} axis; expected one that the cam {} can drive",
                               machine.id, name_of(cam->slave), cam->name));
}

}  // namespace stiction::host
