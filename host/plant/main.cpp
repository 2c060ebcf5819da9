// The program `stiction-plant`: the simulated machine behind a real bus, for the drive's programme to run against.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "firmware/version/version.hpp"
#include "hal/program.hpp"
#include "hal/tick_clock.hpp"
#include "host/plant/can_nodes.hpp"
#include "host/plant/gpio_machine.hpp"
#include "host/plant/modbus_slave.hpp"
#include "host/plant/plant_options.hpp"
#include "host/plant/simulated_machine.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

int serve(const PlantOptions& options) {
  hal::install_signal_reactions();
  const auto file = machine::find_machine(options.machine);
  const auto machine = sim::read_machine(file, {options.experiment, options.set});
  const auto setup = machine::read_drive_setup(file, machine, {options.experiment, options.set});
  const auto start = start_positions(options, machine);
  const auto marks = marks_of(options, machine);
  SimulatedMachine simulated(machine, {start, marks, options.seed}, faults_of(options, machine),
                             [&](const PlantFault& fault, std::uint64_t tick) {
                               fmt::print("{:.6f} s, tick {}: {} on axis {} for {} ticks\n",
                                          static_cast<double>(hal::MonotonicTime{}.now_ns()) * 1e-9, tick,
                                          fault.kind->name, machine.axes[fault.axis].name, fault.ticks);
                             });
  const auto announce = [&] {
    fmt::print("stiction-plant: {} on {}, {} axes\n", machine.id, options.bus, machine.axes.size());
    std::fflush(stdout);
  };
  const auto stop = [] { return hal::stop_wanted != 0; };
  const auto period_ns = machine::fast_period_ns(machine.timing);
  if (const auto bus = bus_of(options); bus.kind == "modbus") {
    if (machine.axes.size() != 1)
      throw PlantOptionError(
          fmt::format("--bus: found a machine with {} axes; expected one, as a Modbus slave is one power stage",
                      machine.axes.size()));
    ModbusSlave slave(bus.name, period_ns, simulated.under_bus());
    announce();
    slave.serve(stop);
    fmt::print("stiction-plant: {} ticks\n", simulated.ticks());
  } else if (bus.kind == "gpio") {
    GpioMachine lines(gpio_machine_config(machine, setup, start, marks), simulated.under_bus(), simulated.faults());
    announce();
    lines.serve(stop);
    fmt::print("stiction-plant: {} ticks, at most {} edges a tick\n", simulated.ticks(), lines.most_edges());
  } else {
    CanNodes nodes(can_nodes_config(options, machine, setup), simulated.under_bus(), simulated.faults());
    announce();
    nodes.serve(stop);
    fmt::print("stiction-plant: {} ticks, {} damaged commands\n", simulated.ticks(), nodes.damaged_commands());
  }
  for (const auto& line : simulated.describe()) fmt::print("{}\n", line);
  return 0;
}

}  // namespace
}  // namespace stiction::host

int main(int argc, char** argv) {
  return stiction::hal::run_program<stiction::host::PlantOptions>(
      argc, argv,
      {"stiction-plant", "the simulated machine on a real bus, as the counterpart of stictiond",
       stiction::program_version},
      stiction::host::serve);
}
