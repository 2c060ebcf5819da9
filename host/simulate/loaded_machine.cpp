#include "host/simulate/loaded_machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "host/log/message.hpp"
#include "sim/effects/effects.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

void keep_axis(machine::Machine& machine, const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) {
    const auto nearest = machine::nearest_name(name, names);
    throw machine::MachineFileError(fmt::format("--axis: found '{}'; expected an axis of {}: {}{}", excerpt(name),
                                                machine.id, fmt::join(names, ", "),
                                                nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  const std::string kept(name.empty() ? names.front() : std::string_view(name));
  std::erase_if(machine.axes, [&](const auto& axis) { return axis.name != kept; });
}

}  // namespace

machine::Machine load_machine(const std::string& name, const std::vector<std::string>& set,
                              const std::string& experiment, const MachineNeeds& needs, const std::string& axis) {
  const auto file = machine::find_machine(name);
  auto result = sim::read_machine(file, {experiment, set});
  if (needs.one_axis && !result.axes.empty()) keep_axis(result, axis);
  if (const auto missing = what_is_missing(result, needs))
    throw machine::MachineFileError(fmt::format("{}: {}", file.string(), *missing));
  if (needs.formats == Formats::any || (needs.formats == Formats::or_doubles && !result.fits_formats())) return result;
  // What the drive's number formats cannot hold is bad input too, found before anything runs.
  try {
    for (const auto& each : result.axes)
      if (each.cascaded()) machine::configure_axis<FixedSignals>(result.timing, sim::drive_axis(each));
    machine::configure_compensations<FixedSignals>(result);
  } catch (const machine::ConfigurationError& error) {
    throw machine::MachineFileError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return result;
}

}  // namespace stiction::host
