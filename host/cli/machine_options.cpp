#include "host/cli/machine_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/file/compensation_parameters.hpp"
#include "firmware/machine/file/units.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/loaded_machine.hpp"
#include "sim/plant/friction/friction.hpp"

namespace stiction::host {

void MachineOptions::add_to(CLI::App& command, const std::string& machine_help) {
  command.add_option("--machine", machine, machine_help)->required()->type_name("MACHINE");
  command.add_option("--set", set, "override a key of the machine file; may be repeated; axis.* means every axis")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void MachineOptions::add_compensation_to(CLI::App& command) {
  std::vector<std::string> names;
  for (const auto& kind : machine::compensation_kinds) names.emplace_back(kind.name);
  command
      .add_option("--compensation", compensation,
                  "friction compensation of every axis, with parameters of the machine file [as in the machine file]")
      ->check(one_of(names))
      ->type_name("KIND");
}

void MachineOptions::add_axis_to(CLI::App& command) {
  command.add_option("--axis", axis, "the axis that the experiment runs on [the machine's first]")->type_name("AXIS");
}

void require_needs(const machine::Machine& machine, const MachineNeeds& needs, const std::filesystem::path& file) {
  if (const auto missing = what_is_missing(machine, needs))
    throw UsageError(fmt::format("{}: {}", file.string(), *missing));
}

machine::Machine MachineOptions::load(const std::string& name, const std::string& experiment) const {
  return load(name, experiment, needs_of(experiment));
}

machine::Machine MachineOptions::load(const std::string& name, const std::string& experiment,
                                      const MachineNeeds& needs) const {
  auto assignments = set;
  if (!compensation.empty()) assignments.push_back(compensation_assignment(compensation));
  return load_machine(name, assignments, experiment, needs, axis);
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (auto part : CLI::detail::split(text, ',')) parts.push_back(CLI::detail::trim(part));
  return parts;
}

std::vector<std::string> friction_models(const std::string& text, const machine::Machine& machine) {
  std::vector<std::string> everywhere, all{"all"};
  for (const auto& law : sim::friction_tables()) {
    const std::string name(law.name);
    all.push_back(name);
    if (std::all_of(machine.axes.begin(), machine.axes.end(),
                    [&](const auto& axis) { return axis.friction.models.contains(name); }))
      everywhere.push_back(name);
  }
  if (text == "all") return everywhere;
  if (text.empty()) return {friction_in_use(machine)};
  const auto names = split_list(text);
  for (const auto& name : names) {
    if (std::find(everywhere.begin(), everywhere.end(), name) != everywhere.end()) continue;
    const bool law = std::find(all.begin(), all.end(), name) != all.end();
    throw UsageError(fmt::format("--friction: found '{}'{}; expected 'all' or models that every axis of {} has: {}{}",
                                 name, law ? ", of which an axis has no parameters" : "", machine.id,
                                 fmt::join(everywhere, ", "), law ? "" : nearest_words(name, all)));
  }
  return names;
}

// "8,5 m/min": one number, and no list of them, which have units.
void refuse_decimal_comma(const std::string& text, const std::string& option) {
  const auto digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
  for (std::size_t k = 1; k + 1 < text.size(); ++k)
    if (text[k] == ',' && digit(k - 1) && digit(k + 1))
      throw UsageError(
          fmt::format("{}: found '{}' (a comma between digits); expected numbers with a decimal point, as in \"8.5 "
                      "m/min\", each with its unit in a list, as in \"8 m/min, 16 m/min\"",
                      option, text));
}

std::vector<double> feeds(const std::string& text, const std::string& option) {
  refuse_decimal_comma(text, option);
  std::vector<double> result;
  for (const auto& part : split_list(text)) {
    try {
      result.push_back(machine::parse_quantity(part, "m/s"));
    } catch (const machine::UnitError& error) {
      throw UsageError(
          fmt::format("{}: found '{}' ({}); expected a speed such as \"16 m/min\", or a list \"8 m/min, "
                      "16 m/min\"",
                      option, part, error.what()));
    }
  }
  return result;
}

std::vector<sim::Direction> directions(const std::string& text) {
  if (text == "ccw") return {sim::Direction::counter_clockwise};
  if (text == "cw") return {sim::Direction::clockwise};
  if (text == "both") return {sim::Direction::counter_clockwise, sim::Direction::clockwise};
  throw UsageError(fmt::format("--direction: found '{}'; expected cw, ccw or both{}", text,
                               nearest_words(text, {"cw", "ccw", "both"})));
}

}  // namespace stiction::host
