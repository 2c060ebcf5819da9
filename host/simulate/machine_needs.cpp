#include "host/simulate/machine_needs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

namespace stiction::host {
namespace {

constexpr std::array<std::string_view, 1> with_bristles{"lugre"};
constexpr std::array<std::string_view, 2> with_sticking{"lugre", "classical"};

constexpr std::string_view for_a_circle = "one for each coordinate of the circle, or one alone for a sine";
constexpr std::string_view for_both_coordinates = "one for each coordinate of the circle";

constexpr std::array table{
    MachineNeeds{.command = ""},
    MachineNeeds{.command = "circle", .most_axes = 2, .why = for_a_circle},
    MachineNeeds{.command = "constant-velocity",
                 .one_axis = true,
                 .rotary = true,
                 .controllers = Controllers::known,
                 .formats = Formats::or_doubles},
    MachineNeeds{.command = "impact",
                 .one_axis = true,
                 .rotary = true,
                 .controllers = Controllers::known,
                 .formats = Formats::or_doubles},
    MachineNeeds{
        .command = "l-shape", .least_axes = 2, .most_axes = 2, .why = "one is at standstill while the other moves"},
    MachineNeeds{.command = "presliding", .friction = with_bristles, .one_axis = true},
    MachineNeeds{.command = "friction-lag", .friction = with_bristles, .one_axis = true},
    MachineNeeds{.command = "break-away", .friction = with_bristles, .one_axis = true},
    MachineNeeds{.command = "stick-slip", .friction = with_sticking, .one_axis = true},
    MachineNeeds{.command = "feed-cutting", .least_axes = 0, .feed_drive = true},
    MachineNeeds{.command = "frequency-response", .rotary = true},
    MachineNeeds{.command = "frequency-response --loop current",
                 .current_controller = true,
                 .rotary = true,
                 .why = "of which the current loop consists"},
    MachineNeeds{
        .command = "compare --reference circle", .most_axes = 2, .circle_references = true, .why = for_a_circle},
    MachineNeeds{.command = "identify --reference circle",
                 .least_axes = 2,
                 .most_axes = 2,
                 .circle_references = true,
                 .why = for_both_coordinates},
    MachineNeeds{.command = "diagnose --reference circle",
                 .least_axes = 2,
                 .most_axes = 2,
                 .circle_references = true,
                 .why = for_both_coordinates},
    MachineNeeds{.command = "machine",
                 .least_axes = 0,
                 .rotary = true,
                 .controllers = Controllers::any,
                 .formats = Formats::or_doubles},
    MachineNeeds{.command = "inspect", .rotary = true, .controllers = Controllers::any, .formats = Formats::or_doubles},
    MachineNeeds{.command = "replay", .rotary = true, .controllers = Controllers::known},
    MachineNeeds{
        .command = "diagnose", .rotary = true, .controllers = Controllers::any, .formats = Formats::or_doubles},
    MachineNeeds{
        .command = "commissioning", .rotary = true, .controllers = Controllers::known, .formats = Formats::or_doubles},
    MachineNeeds{.command = "identify", .rotary = true, .controllers = Controllers::any, .formats = Formats::any},
};

std::string found_axes(const machine::Machine& machine) {
  if (machine.axes.empty()) return machine.feed_drive ? "a feed drive and no axis" : "no axis";
  if (machine.axes.size() == 1) return fmt::format("axis {} alone", machine.axes.front().name);
  std::vector<std::string> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  return fmt::format("{} axes, {}", names.size(), fmt::join(names, ", "));
}

std::string in_words(std::size_t count) { return count == 1 ? "one" : count == 2 ? "two" : fmt::format("{}", count); }

std::string expected_axes(const MachineNeeds& needs) {
  const auto count = [&] {
    const auto least = in_words(needs.least_axes);
    if (needs.most_axes == needs.least_axes) return "exactly " + least;
    if (needs.most_axes == any_number) return "at least " + least;
    return fmt::format("{} or {}", least, in_words(needs.most_axes));
  }();
  const bool several = needs.least_axes > 1 || needs.most_axes != any_number;
  const auto machine = fmt::format("a machine with {} ax{}s", count, several ? "e" : "i");
  if (needs.why.empty()) return fmt::format("a machine with a table [axis.NAME]");
  return fmt::format("{}: {}", machine, needs.why);
}

bool every_axis_has(const machine::Machine& machine, std::string_view model) {
  return std::all_of(machine.axes.begin(), machine.axes.end(),
                     [&](const machine::AxisModel& axis) { return axis.friction.models.contains(std::string(model)); });
}

std::string found_friction(const machine::Machine& machine) {
  std::vector<std::string> found;
  for (const auto& axis : machine.axes) {
    std::vector<std::string> models;
    for (const auto& [name, parameters] : axis.friction.models) models.push_back(name);
    found.push_back(fmt::format("axis {} with parameters of {}", axis.name, fmt::join(models, ", ")));
  }
  return fmt::format("{}", fmt::join(found, "; "));
}

}  // namespace

const MachineNeeds& needs_of(std::string_view command) {
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const MachineNeeds& needs) { return needs.command == command; });
  return row == table.end() ? table.front() : *row;
}

std::optional<std::string> what_is_missing(const machine::Machine& machine, const MachineNeeds& needs) {
  const auto missing = [](const std::string& found, const std::string& expected) {
    return fmt::format("found {}; expected {}", found, expected);
  };
  if (needs.feed_drive && !machine.feed_drive)
    return missing("axes and no feed drive", "a machine with a table [feed_drive], such as stick-slip-feed");
  if (machine.axes.size() < needs.least_axes || machine.axes.size() > needs.most_axes)
    return missing(found_axes(machine), expected_axes(needs));
  if (!needs.rotary)
    for (const auto& axis : machine.axes)
      if (axis.coordinate.rotary())
        return missing(fmt::format("the rotary axis {}", axis.name),
                       "linear axes; inspect, identify, diagnose, compare LOG and simulate replay, commissioning, "
                       "constant-velocity, impact and frequency-response serve rotary ones");
  for (const auto& axis : machine.axes) {
    if (axis.cascaded() || needs.controllers == Controllers::any) continue;
    const bool unknown = axis.controller->structure == machine::ControlStructure::unknown;
    if (needs.controllers == Controllers::cascade)
      return missing(
          fmt::format("axis {} with {}", axis.name,
                      unknown ? "an unknown controller" : "a controller that is not the firmware's cascade"),
          "the cascade, without [axis.NAME.controller]; inspect, identify, diagnose, compare LOG and simulate replay, "
          "commissioning, constant-velocity and impact serve other structures");
    if (unknown)
      return missing(fmt::format("axis {} with an unknown controller", axis.name),
                     "a controller to simulate: [axis.NAME.controller] with its structure, or the cascade without it");
  }
  if (!needs.friction.empty() && std::none_of(needs.friction.begin(), needs.friction.end(),
                                              [&](std::string_view model) { return every_axis_has(machine, model); }))
    return missing(found_friction(machine), fmt::format("parameters of a friction model that {} makes sense for: {}",
                                                        needs.command, fmt::join(needs.friction, ", ")));
  if (needs.current_controller &&
      std::none_of(machine.axes.begin(), machine.axes.end(),
                   [](const machine::AxisModel& axis) { return axis.current_controller.has_value(); }))
    return missing(fmt::format("no current controller on {}", found_axes(machine)),
                   fmt::format("an axis with [axis.NAME.current_controller], {}", needs.why));
  if (needs.circle_references && machine.circle_references.empty())
    return missing("no row [[reference.circle]]", "at least one, of a published or measured circle of this machine");
  return std::nullopt;
}

}  // namespace stiction::host
