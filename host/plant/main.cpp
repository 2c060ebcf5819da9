// The program `stiction-plant`: the simulated machine behind a real bus, for the drive's programme to run against.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "hal/simulated/faulty_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "host/plant/can_nodes.hpp"
#include "host/plant/modbus_slave.hpp"
#include "host/plant/motion_record.hpp"
#include "host/plant/plant_options.hpp"
#include "sim/control/axis_configuration.hpp"
#include "sim/machine/drive_file.hpp"
#include "sim/machine/machine_file.hpp"

namespace stiction::host {
namespace {

volatile std::sig_atomic_t stop_wanted = 0;

int serve(const PlantOptions& options) {
  const auto file = sim::find_machine(options.machine);
  const auto machine = sim::read_machine(file, {options.experiment, options.set});
  const auto setup = sim::read_drive_setup(file, machine, {options.experiment, options.set});
  const auto start = start_positions(machine, options.at);

  hal::SimulatedBackend<FixedSignals> simulated(machine, start, options.seed);
  hal::FaultyBackend faulty(simulated, sim::fast_period_ns(machine.timing), machine.axes.front().encoder.increment);
  MotionRecord record(machine.axes.size());
  const auto faults = faults_of(options, machine);
  std::uint64_t tick = 0;
  const auto break_parts = [&] {
    for (const auto& fault : faults)
      if (fault.kind->machine != nullptr)
        fault.kind->machine(faulty.faults(fault.axis), fault.acts(tick + 1));  // of the sample to come
  };
  const PlantUnderBus plant{[&](std::span<const Command<FixedSignals>> commands) {
                              break_parts();
                              faulty.write(commands);
                              faulty.wait_for_tick();
                              ++tick;
                              for (std::size_t i = 0; i < commands.size(); ++i)
                                record.add(i, commands[i].enable, simulated.plant(i).position());
                            },
                            [&](auto feedback, auto inputs) {
                              faulty.read(feedback);
                              faulty.read_inputs(inputs);
                            }};
  faulty.wait_for_tick();  // the start
  const auto announce = [&] {
    fmt::print("stiction-plant: {} on {}, {} axes\n", machine.id, options.bus, machine.axes.size());
    std::fflush(stdout);
  };
  const auto stop = [] { return stop_wanted != 0; };
  if (const auto bus = bus_of(options); bus.kind == "modbus") {
    if (machine.axes.size() != 1)
      throw PlantOptionError(fmt::format(
          "--bus: found a machine with {} axes; expected one: a Modbus slave is one stage", machine.axes.size()));
    ModbusSlave slave(bus.name, sim::fast_period_ns(machine.timing), plant);
    announce();
    slave.serve(stop);
    fmt::print("stiction-plant: {} ticks\n", slave.ticks());
  } else {
    CanNodes nodes(can_nodes_config(options, machine, setup), plant);
    announce();
    nodes.serve(stop);
    fmt::print("stiction-plant: {} ticks, {} damaged commands\n", nodes.ticks(), nodes.damaged_commands());
  }
  for (std::size_t i = 0; i < machine.axes.size(); ++i) fmt::print("{}\n", record.describe(machine.axes[i].name, i));
  return 0;
}

int run(int argc, char** argv) {
  CLI::App program("the simulated machine behind a real bus, for stictiond to run against", "stiction-plant");
  program.set_version_flag("--version", STICTION_VERSION);
  PlantOptions options;
  options.add_to(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    return program.exit(wanted);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "stiction-plant: {}; see stiction-plant --help\n", error.what());
    return 2;
  }
  struct sigaction action {};
  action.sa_handler = [](int) { stop_wanted = 1; };
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  try {
    return serve(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stiction-plant: {}\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace stiction::host

int main(int argc, char** argv) {
  try {
    return stiction::host::run(argc, argv);
  } catch (...) {
    return 1;  // standard error cannot be written either
  }
}
