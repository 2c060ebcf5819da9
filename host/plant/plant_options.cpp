#include "host/plant/plant_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "firmware/machine/file/units.hpp"

namespace stiction::host {
namespace {

std::size_t axis_named(const machine::Machine& machine, const std::string& name, const std::string& option) {
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
    return machine::parse_quantity(text, unit);
  } catch (const machine::UnitError& error) {
    throw PlantOptionError(
        fmt::format("{}: found '{}' ({}); expected a quantity in {}", option, text, error.what(), unit));
  }
}

std::uint64_t ticks_of(const std::string& text, const machine::Machine& machine, const std::string& option) {
  const double seconds = quantity(text, "s", option);
  if (seconds < 0.0) throw PlantOptionError(fmt::format("{}: found '{}'; expected a time from 0 on", option, text));
  return static_cast<std::uint64_t>(std::llround(seconds / machine.timing.fast_period));
}

const PlantFaultKind& kind_named(const std::string& name, const std::string& bus) {
  std::vector<std::string_view> names;
  for (const auto& row : plant_faults) {
    if (!row.possible_on(bus)) continue;
    if (row.name == name) return row;
    names.push_back(row.name);
  }
  throw PlantOptionError(
      fmt::format("--fault: found '{}' on the bus {}; expected one of {}", name, bus, fmt::join(names, ", ")));
}

// "KIND,axis=X,at=1.5 s,ticks=3"
PlantFault plant_fault(const std::string& text, const std::string& bus, const machine::Machine& machine) {
  const auto parts = CLI::detail::split(text, ',');
  PlantFault fault{.kind = &kind_named(parts.front(), bus)};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto equals = parts[i].find('=');
    const std::string key = parts[i].substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : parts[i].substr(equals + 1);
    if (key == "axis") {
      fault.axis = axis_named(machine, value, "--fault");
    } else if (key == "at") {
      fault.from_tick = ticks_of(value, machine, "--fault");
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

// For the help: where a kind can be had.
std::string_view bus_note(const PlantFaultKind& kind) {
  if (!kind.possible_on("gpio")) return kind.possible_on("modbus") ? "not on gpio: " : "can: ";
  if (!kind.possible_on("can")) return "gpio: ";
  return kind.possible_on("modbus") ? "" : "not on modbus: ";
}

struct MarkName {
  std::string_view name;
  void (*set)(hal::AxisMarks&, double);
};
constexpr std::array<MarkName, 5> mark_names{{
    {"limit_negative", [](auto& marks, double x) { marks.limit_negative = x; }},
    {"limit_positive", [](auto& marks, double x) { marks.limit_positive = x; }},
    {"home", [](auto& marks, double x) { marks.home = x; }},
    {"index", [](auto& marks, double x) { marks.index = x; }},
    {"index_every", [](auto& marks, double x) { marks.index_every = x; }},
}};

}  // namespace

void PlantOptions::add_to(CLI::App& program) {
  program.add_option("--machine", machine, "machine file, or the name of a shipped machine")->required();
  program
      .add_option("--bus", bus,
                  "bus on which the machine answers: can:INTERFACE, modbus:HOST:PORT, modbus:DEVICE, or gpio for the "
                  "lines of [drive] in the machine file on a gpio-sim chip")
      ->required()
      ->type_name("KIND:NAME");
  program.add_option("--experiment", experiment, "apply the overrides of [experiment.NAME]")->type_name("NAME");
  program.add_option("--set", set, "override a key of the machine file; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  program.add_option("--at", at, "initial position of an axis; may be repeated [0 mm]")
      ->type_name("AXIS=QUANTITY")
      ->allow_extra_args(false);
  program
      .add_option("--mark", marks,
                  "position of a switch or index mark; may be repeated: X.index=100 mm. limit_negative and home are "
                  "active below it, limit_positive above it; index_every: distance between index marks [one mark]")
      ->type_name("AXIS.MARK=QUANTITY")
      ->allow_extra_args(false);
  std::string faults_help = "a fault; may be repeated: KIND,axis=X,at=1.5 s,ticks=3. KIND:";
  for (const auto& row : plant_faults) faults_help += fmt::format(" {} ({}{});", row.name, bus_note(row), row.text);
  faults_help.back() = '.';
  program.add_option("--fault", faults, faults_help)->type_name("FAULT")->allow_extra_args(false);
  program
      .add_option("--fault-every", fault_every,
                  "inject one of the faults of --fault at a time, regardless of their at=, at random times with this "
                  "mean interval, drawn with --seed")
      ->type_name("TIME");
  program.add_option("--seed", seed, "seed of the simulated noise and of --fault-every")->capture_default_str();
}

PlantBus bus_of(const PlantOptions& options) {
  const auto colon = options.bus.find(':');
  const PlantBus bus{options.bus.substr(0, colon), colon == std::string::npos ? "" : options.bus.substr(colon + 1)};
  const bool named = bus.kind == "can" || bus.kind == "modbus";
  if (!(named && !bus.name.empty()) && options.bus != "gpio")
    throw PlantOptionError(
        fmt::format("--bus: found '{}'; expected can:INTERFACE, modbus:HOST:PORT, modbus:DEVICE or gpio", options.bus));
  return bus;
}

std::vector<double> start_positions(const PlantOptions& options, const machine::Machine& machine) {
  std::vector<double> positions(machine.axes.size());
  for (const auto& text : options.at) {
    const auto equals = text.find('=');
    if (equals == std::string::npos)
      throw PlantOptionError(fmt::format("--at: found '{}'; expected AXIS=QUANTITY such as X=90 mm", text));
    positions[axis_named(machine, text.substr(0, equals), "--at")] = quantity(text.substr(equals + 1), "m", "--at");
  }
  return positions;
}

std::vector<hal::AxisMarks> marks_of(const PlantOptions& options, const machine::Machine& machine) {
  std::vector<hal::AxisMarks> marks(machine.axes.size());
  for (const auto& text : options.marks) {
    const auto equals = text.find('='), dot = text.substr(0, equals).rfind('.');
    if (equals == std::string::npos || dot == std::string::npos)
      throw PlantOptionError(fmt::format("--mark: found '{}'; expected AXIS.MARK=QUANTITY such as X.index=0 mm", text));
    const std::string name = text.substr(dot + 1, equals - dot - 1);
    const auto row =
        std::find_if(mark_names.begin(), mark_names.end(), [&](const MarkName& each) { return each.name == name; });
    if (row == mark_names.end()) {
      std::vector<std::string_view> names;
      for (const auto& each : mark_names) names.push_back(each.name);
      throw PlantOptionError(fmt::format("--mark: found '{}'; expected one of {}", name, fmt::join(names, ", ")));
    }
    row->set(marks[axis_named(machine, text.substr(0, dot), "--mark")],
             quantity(text.substr(equals + 1), "m", "--mark"));
  }
  return marks;
}

FaultSchedule faults_of(const PlantOptions& options, const machine::Machine& machine) {
  const auto bus = bus_of(options).kind;
  std::vector<PlantFault> faults;
  for (const auto& text : options.faults) faults.push_back(plant_fault(text, bus, machine));
  if (options.fault_every.empty()) return FaultSchedule(std::move(faults));
  const auto mean = static_cast<double>(ticks_of(options.fault_every, machine, "--fault-every"));
  if (faults.empty()) throw PlantOptionError("--fault-every: found no --fault; expected at least one to choose from");
  for (const auto& fault : faults)
    if (static_cast<double>(fault.ticks) >= FaultSchedule::quiet_share * mean)
      throw PlantOptionError(
          fmt::format("--fault-every: found {} for {} ticks; expected less than a quarter of '{}', {} ticks",
                      fault.kind->name, fault.ticks, options.fault_every, mean));
  return {std::move(faults), mean, options.seed};
}

CanNodesConfig can_nodes_config(const PlantOptions& options, const machine::Machine& machine,
                                const machine::DriveSetup& setup) {
  CanNodesConfig config;
  config.interface = bus_of(options).name;
  config.format = setup.can && !setup.can->data_bit_rate ? hal::can::Format::classical : hal::can::Format::fd;
  for (const auto& axis : machine.axes) config.nodes.push_back(setup.axes.at(axis.name).node);
  return config;
}

}  // namespace stiction::host
