// The program `stictiond`: the drive on a Linux industrial PC.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "firmware/drive/motion.hpp"
#include "firmware/drive/trace.hpp"
#include "hal/can/can_backend.hpp"
#include "hal/control_loop.hpp"
#include "sim/control/axis_configuration.hpp"
#include "sim/machine/drive_file.hpp"
#include "sim/machine/machine_file.hpp"
#include "sim/machine/units.hpp"

namespace stiction::drive {
namespace {

int run(int argc, char** argv) {
  CLI::App program("the drive", "stictiond");
  std::string machine_name, hal = "simulated", circle, trace_file;
  std::vector<std::string> set;
  program.add_option("--machine", machine_name, "machine")->required();
  program.add_option("--hal", hal, "backend");
  program.add_option("--circle", circle, "feed");
  program.add_option("--trace", trace_file, "log");
  program.add_option("--set", set, "key=value")->allow_extra_args(false);
  CLI11_PARSE(program, argc, argv);
  const auto file = sim::find_machine(machine_name);
  const sim::ReadOptions options{"circle", set};
  const auto machine = sim::read_machine(file, options);
  const auto setup = sim::read_drive_setup(file, machine, options);
  const auto motion = Motion::circle(machine, sim::parse_quantity(circle, "m/s"));
  Trace trace(machine.axes.size(), motion.ticks());
  hal::TickClock clock(sim::fast_period_ns(machine.timing));
  hal::can::CanBackendConfig can{.interface = setup.can->interface, .nodes = {}};
  std::vector<std::string> names;
  std::vector<AxisConfig<FixedSignals>> configs;
  for (const auto& axis : machine.axes) {
    can.nodes.push_back(setup.axes.at(axis.name).node);
    names.push_back(axis.name);
    configs.push_back(sim::configure_axis<FixedSignals>(machine.timing, axis));
  }
  hal::can::CanBackend backend(can, clock);
  hal::ControlLoop loop(backend, std::span<const AxisConfig<FixedSignals>>(configs),
                        Ticker(clock.period_ns(), static_cast<std::uint32_t>(sim::slow_ratio(machine.timing))));
  const std::int64_t start = loop.now_ns();
  for (std::size_t i = 0; i < motion.ticks() && !loop.faulted(); ++i) {
    const std::int64_t now = loop.now_ns();
    loop.tick(motion.at(i));
    trace.add(now - start, loop.signals());
  }
  fmt::print("faulted {} missed {}\n", loop.faulted(), clock.missed());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& c = backend.counts(i);
    fmt::print("{}: good {} lost {} bad {} fault {}\n", names[i], c.good, c.lost, c.bad(),
               name_of(loop.axes()[i].fault()));
  }
  trace.write(trace_file, names, {});
  return loop.faulted() ? 1 : 0;
}

}  // namespace
}  // namespace stiction::drive

int main(int argc, char** argv) {
  try {
    return stiction::drive::run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "stictiond: {}\n", e.what());
    return 2;
  }
}
