#include "host/cli/machine_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine/file/compensation_parameters.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/simulate/loaded_machine.hpp"

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

}  // namespace stiction::host
