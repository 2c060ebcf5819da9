#include "host/plant/plant_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/machine/units.hpp"

namespace stiction::host {
namespace {

std::size_t axis_named(const sim::Machine& machine, const std::string& name, const std::string& option) {
  std::vector<std::string> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  const auto place = std::find(names.begin(), names.end(), name);
  if (place == names.end())
    throw PlantOptionError(
        fmt::format("{}: found axis '{}'; expected one of {}", option, name, fmt::join(names, ", ")));
  return static_cast<std::size_t>(place - names.begin());
}

double quantity(const std::string& text, const std::string& unit, const std::string& option) {
  try {
    return sim::parse_quantity(text, unit);
  } catch (const sim::UnitError& error) {
    throw PlantOptionError(
        fmt::format("{}: found '{}' ({}); expected a quantity in {}", option, text, error.what(), unit));
  }
}

// "KIND,axis=X,at=1.5 s,ticks=3"
PlantFault plant_fault(const std::string& text, const sim::Machine& machine) {
  const auto parts = CLI::detail::split(text, ',');
  const auto named = std::find_if(plant_faults.begin(), plant_faults.end(),
                                  [&](const auto& row) { return row.name == parts.front(); });
  if (named == plant_faults.end()) {
    std::vector<std::string_view> names;
    for (const auto& row : plant_faults) names.push_back(row.name);
    throw PlantOptionError(
        fmt::format("--fault: found '{}'; expected one of {}", parts.front(), fmt::join(names, ", ")));
  }
  PlantFault fault{.kind = &*named};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto equals = parts[i].find('=');
    const std::string key = parts[i].substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : parts[i].substr(equals + 1);
    if (key == "axis") {
      fault.axis = axis_named(machine, value, "--fault");
    } else if (key == "at") {
      fault.from_tick =
          static_cast<std::uint64_t>(std::llround(quantity(value, "s", "--fault") / machine.timing.fast_period));
    } else if (key == "ticks") {
      const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), fault.ticks);
      if (error != std::errc{} || end != value.data() + value.size())
        throw PlantOptionError(fmt::format("--fault: found ticks='{}'; expected a whole number", value));
    } else {
      throw PlantOptionError(fmt::format("--fault: found '{}'; expected axis=, at= or ticks=", parts[i]));
    }
  }
  return fault;
}

}  // namespace

void PlantOptions::add_to(CLI::App& program) {
  program.add_option("--machine", machine, "machine file, or the name of a shipped machine")->required();
  program.add_option("--bus", bus, "bus to answer on: can:INTERFACE, modbus:HOST:PORT or modbus:DEVICE")
      ->required()
      ->type_name("KIND:NAME");
  program.add_option("--experiment", experiment, "with the overrides of [experiment.NAME]")->type_name("NAME");
  program.add_option("--set", set, "another value for a key of the machine file; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  program.add_option("--at", at, "where an axis stands at the start; may be repeated [0 mm]")
      ->type_name("AXIS=QUANTITY")
      ->allow_extra_args(false);
  std::string faults_help = "a fault; may be repeated: KIND,axis=X,at=1.5 s,ticks=3. KIND:";
  for (const auto& row : plant_faults) faults_help += fmt::format(" {} ({});", row.name, row.text);
  faults_help.back() = '.';
  program.add_option("--fault", faults, faults_help)->type_name("FAULT")->allow_extra_args(false);
  program.add_option("--seed", seed, "of the simulated noise")->capture_default_str();
}

PlantBus bus_of(const PlantOptions& options) {
  const auto colon = options.bus.find(':');
  const PlantBus bus{options.bus.substr(0, colon), colon == std::string::npos ? "" : options.bus.substr(colon + 1)};
  if ((bus.kind != "can" && bus.kind != "modbus") || bus.name.empty())
    throw PlantOptionError(
        fmt::format("--bus: found '{}'; expected can:INTERFACE, modbus:HOST:PORT or modbus:DEVICE", options.bus));
  return bus;
}

std::vector<double> start_positions(const sim::Machine& machine, const std::vector<std::string>& at) {
  std::vector<double> positions(machine.axes.size());
  for (const auto& text : at) {
    const auto equals = text.find('=');
    if (equals == std::string::npos)
      throw PlantOptionError(fmt::format("--at: found '{}'; expected AXIS=QUANTITY such as X=90 mm", text));
    positions[axis_named(machine, text.substr(0, equals), "--at")] = quantity(text.substr(equals + 1), "m", "--at");
  }
  return positions;
}

std::vector<PlantFault> faults_of(const PlantOptions& options, const sim::Machine& machine) {
  std::vector<PlantFault> faults;
  for (const auto& text : options.faults) faults.push_back(plant_fault(text, machine));
  return faults;
}

CanNodesConfig can_nodes_config(const PlantOptions& options, const sim::Machine& machine,
                                const sim::DriveSetup& setup) {
  CanNodesConfig config;
  config.interface = bus_of(options).name;
  config.format = setup.can && !setup.can->data_bit_rate ? hal::can::Format::classical : hal::can::Format::fd;
  for (const auto& axis : machine.axes) config.nodes.push_back(setup.axes.at(axis.name).node);
  config.faults = faults_of(options, machine);
  return config;
}

}  // namespace stiction::host
