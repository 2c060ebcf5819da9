#include "firmware/stictiond/configuration.hpp"

#include <fmt/format.h>

#include "firmware/machine/configuration/compensation_configuration.hpp"
#include "firmware/machine/configuration/drive_configuration.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/model/shipped_vocabulary.hpp"
#include "firmware/stictiond/parameters.hpp"
#include "firmware/stictiond/remote_setup.hpp"
#include "hal/can/can_socket.hpp"

namespace stiction::drive {

std::filesystem::path parameter_file(const DriveOptions& options) {
  return options.parameters.empty() ? std::filesystem::path()
                                    : std::filesystem::path(options.parameters) / "parameters";
}

namespace {

void check_axes(const machine::Machine& machine, const std::string& file) {
  if (machine.axes.empty()) throw StartRefused(fmt::format("{}: found no axis; expected a table [axis.NAME]", file));
  for (const auto& axis : machine.axes) {
    if (!axis.cascaded())
      throw StartRefused(fmt::format(
          "{}: found axis {} with a controller that is not the cascade; expected the cascade alone", file, axis.name));
    if (axis.coordinate.rotary())
      throw StartRefused(
          fmt::format("{}: found the rotary axis {}; expected linear axes, in whose units the drive "
                      "speaks with its controllers",
                      file, axis.name));
  }
}

DriveConfiguration build(const DriveOptions& options, std::optional<ParameterSet> stored) {
  const auto file = machine::find_machine(options.machine);
  machine::ReadOptions read{options.circle.empty() ? "" : "circle", options.set};
  auto machine = machine::read_machine(file, machine::shipped_vocabulary(), read);
  check_axes(machine, file.string());
  auto setup = machine::read_drive_setup(file, machine, read);
  if (stored) {
    // What the command line says stands above what was stored.
    auto assignments = assignments_of(*stored, machine.id, drive_parameters(machine, setup));
    assignments.insert(assignments.end(), options.set.begin(), options.set.end());
    read.set = assignments;
    machine = machine::read_machine(file, machine::shipped_vocabulary(), read);
    setup = machine::read_drive_setup(file, machine, read);
  }
  const auto period_ns = machine::fast_period_ns(machine.timing);
  DriveConfiguration configuration{
      .file = file,
      .assignments = options.set,
      .stored = std::move(stored),
      .rejected_parameters = {},
      .machine = std::move(machine),
      .setup = std::move(setup),
      .names = {},
      .axes = {},
      .drives = {},
      .compensations = {},
      .period_ns = period_ns,
      .ticker = Ticker(period_ns, 1),
  };
  auto& c = configuration;
  c.ticker = Ticker(period_ns, static_cast<std::uint32_t>(machine::slow_ratio(c.machine.timing)));
  for (const auto& axis : c.machine.axes) {
    c.names.push_back(axis.name);
    c.axes.push_back(machine::configure_axis<FixedSignals>(c.machine.timing, axis));
  }
  c.drives = machine::configure_drives<FixedSignals>(c.machine, c.setup);
  c.compensations = machine::configure_compensations<FixedSignals>(c.machine);
  return configuration;
}

}  // namespace

void check_whole(const DriveOptions& options, const ParameterSet& set) { check_remote(build(options, set)); }

DriveConfiguration read_configuration(const DriveOptions& options) {
  auto alone = build(options, {});
  if (options.parameters.empty()) return alone;
  const auto file = parameter_file(options);
  std::optional<std::string> rejected;
  for (const auto& candidate : {file, previous_of(file)}) {
    try {
      auto stored = read_parameters(candidate);
      // Without a file the machine file holds, whatever a set before says.
      if (!stored && !rejected) return alone;
      if (!stored) break;
      auto configuration = build(options, std::move(stored));
      check_remote(configuration);
      configuration.rejected_parameters = rejected;
      return configuration;
    } catch (const NoParameterFile&) {
      throw;  // a folder, a pipe or a link in its place is the operator's to remove
    } catch (const std::system_error&) {
      throw;
    } catch (const std::exception& error) {
      if (!rejected) rejected = error.what();
    }
  }
  alone.rejected_parameters = rejected;
  return alone;
}

hal::can::CanBackendConfig can_config(const DriveConfiguration& configuration) {
  if (!configuration.setup.can)
    throw StartRefused(fmt::format("{}: found no table [drive.can]; expected one with the interface and the bit rates",
                                   configuration.machine.id));
  const auto& can = *configuration.setup.can;
  hal::can::CanBackendConfig config;
  config.interface = can.interface;
  config.format = can.data_bit_rate ? hal::can::Format::fd : hal::can::Format::classical;
  for (const auto& axis : configuration.machine.axes)
    if (config.format == hal::can::Format::classical && axis.encoder.velocity == machine::VelocitySource::ideal)
      throw StartRefused(
          fmt::format("{}: found axis.{}.encoder.velocity = \"ideal\" over classical frames, which carry no "
                      "velocity; expected \"estimated\", or drive.can.data_bit_rate for CAN FD",
                      configuration.machine.id, axis.name));
  for (const auto& name : configuration.names) {
    const int node = configuration.setup.axes.at(name).node;
    if (node == 0)
      throw StartRefused(fmt::format("{}: found no drive.axis.{}.node; expected the axis' node on the bus, 1 to 127",
                                     configuration.machine.id, name));
    config.nodes.push_back(node);
  }
  config.others = can_server_identifiers(configuration);
  return config;
}

std::string dbc_page(const DriveConfiguration& configuration) {
  const auto& setup = configuration.setup;
  const auto axes_of = [&](const std::vector<int>& nodes) {
    std::vector<hal::can::DbcAxis> axes;
    for (std::size_t i = 0; i < nodes.size(); ++i) axes.push_back({configuration.names[i], nodes[i]});
    return axes;
  };
  hal::can::DbcBus bus, server;
  if (setup.can || !setup.can_server) {
    const auto config = can_config(configuration);
    bus = {config.format, axes_of(config.nodes)};
  }
  if (setup.can_server) {
    const auto config = can_server_config(configuration);
    server = {config.format, axes_of(config.nodes), config.frames};
  }
  const double increment = setup.can_server ? setup.can_server->position_increment : 0.0;
  return hal::can::dbc_text(bus, server, increment);
}

hal::BusBudget can_bus_budget(const DriveConfiguration& configuration) {
  const auto config = can_config(configuration);
  const auto& can = *configuration.setup.can;
  const bool fd = config.format == hal::can::Format::fd;
  const auto sizes = hal::can::properties(config.format).sizes;
  const double period = configuration.machine.timing.fast_period;
  const auto axes = static_cast<int>(config.nodes.size());
  const auto frame = [&](const char* name, std::size_t size, int per_cycle) {
    return hal::CyclicFrame{.name = name, .bytes = sizes[size], .fd = fd, .per_cycle = per_cycle, .period = period};
  };
  std::vector<hal::CyclicFrame> frames{frame("sync", 0, 1), frame("command", 1, axes), frame("position", 2, axes)};
  if (!fd) frames.push_back(frame("current", 3, axes));
  if (fd) frames.back().name = "feedback";
  if (!config.others.empty())
    for (auto& of_server : can_server_frames(configuration)) frames.push_back(std::move(of_server));
  return hal::can_budget(can.interface, {can.bit_rate, can.data_bit_rate}, frames, hal::can::is_virtual(can.interface));
}

}  // namespace stiction::drive
