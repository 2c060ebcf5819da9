// The program `stictiond`: the drive on a Linux industrial PC.
// Exit statuses: hal/program.hpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <tuple>
#include <vector>

#include "firmware/stictiond/configuration.hpp"
#include "firmware/stictiond/fault_page.hpp"
#include "firmware/stictiond/gpio_setup.hpp"
#include "firmware/stictiond/modbus_registers.hpp"
#include "firmware/stictiond/modbus_setup.hpp"
#include "firmware/stictiond/objects.hpp"
#include "firmware/stictiond/options.hpp"
#include "firmware/stictiond/real_time_check.hpp"
#include "firmware/stictiond/remote_setup.hpp"
#include "firmware/stictiond/run.hpp"
#include "firmware/stictiond/run_record.hpp"
#include "firmware/stictiond/udev_rules.hpp"
#include "firmware/version/version.hpp"
#include "hal/gpio/beside_lines.hpp"
#include "hal/gpio/gpio_backend.hpp"
#include "hal/modbus/modbus_backend.hpp"
#include "hal/paced_backend.hpp"
#include "hal/program.hpp"
#include "hal/simulated/motor_inputs_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"

namespace stiction::drive {
namespace {

using hal::exit_done, hal::exit_fault, hal::exit_refused;

int status_of(const RunResult& result) { return result.faulted ? exit_fault : exit_done; }

int run_simulated(RealTime& real_time, const DriveConfiguration& configuration, const DriveOptions& options,
                  RunRecord& record) {
  const std::vector<double> rest(configuration.machine.axes.size());
  const auto start = options.circle.empty() ? rest : task_of(options, configuration, rest).motion.start();
  hal::SimulatedBackend<FixedSignals> machine(configuration.machine, start);
  hal::MotorInputsBackend simulated(machine, configuration.machine);
  for (std::size_t i = 0; i < configuration.drives.size(); ++i)
    simulated.signals(i).hall_wired = configuration.drives[i].commutation.method == CommutationMethod::hall;
  if (options.unpaced)
    return status_of(run(real_time, simulated, nullptr, configuration, options, "simulated, in its own time", record));
  hal::PacedBackend backend(simulated, configuration.period_ns);
  return status_of(run(real_time, backend, &backend.clock(), configuration, options, "simulated", record));
}

int run_can(RealTime& real_time, const DriveConfiguration& configuration, const DriveOptions& options,
            RunRecord& record) {
  hal::check(can_bus_budget(configuration));
  const auto config = can_config(configuration);
  hal::TickClock clock(configuration.period_ns);
  hal::can::CanBackend backend(config, clock);
  constexpr int patience = 1600;  // ticks
  std::vector<int> silent;
  if (!backend.find_nodes(patience, silent))
    throw StartRefused(fmt::format(
        "can: {}: found no answer of node {}; expected one within {} ticks. Check that it has power and uses {} frames",
        config.interface, fmt::join(silent, ", "), patience, hal::can::properties(config.format).name));
  const std::string title = "can " + config.interface;
  RunResult result;
  if (has_gpio_lines(configuration.setup, configuration.machine)) {
    hal::BesideLines both(backend, configuration.setup.gpio->chip, input_bias(configuration.setup),
                          gpio_lines(configuration.setup, configuration.machine), watchdog_config(configuration.setup),
                          track_lines(configuration.setup));
    result = run(real_time, both, &clock, configuration, options,
                 title + " and lines of " + configuration.setup.gpio->chip, record);
  } else {
    result = run(real_time, backend, &clock, configuration, options, title, record);
  }
  for (std::size_t i = 0; i < configuration.names.size(); ++i) {
    const auto& n = backend.counts(i);
    fmt::print("axis {}: {} answers, {} lost, {} late, {} duplicated, {} out of order, {} stale, {} damaged\n",
               configuration.names[i], n.good, n.lost, n.late, n.duplicate, n.out_of_order, n.stale, n.damaged);
  }
  const auto bus = backend.bus_counts();
  fmt::print("bus: {} frames with an unknown identifier, {} error frames, {} not sent, {} lost in the kernel\n",
             bus.unknown_id, bus.error_frames, bus.send_failed, bus.lost_in_kernel);
  return status_of(result);
}

int run_gpio(RealTime& real_time, const DriveConfiguration& configuration, const DriveOptions& options,
             RunRecord& record) {
  hal::GpioBackend backend(
      gpio_configuration(configuration.setup, configuration.machine, record.broken_off().has_value()),
      configuration.period_ns);
  const auto result = run(real_time, backend, &backend.clock(), configuration, options,
                          "gpio " + configuration.setup.gpio->chip, record);
  for (std::size_t i = 0; i < configuration.names.size(); ++i)
    fmt::print("axis {}: at least {} edges lost; last fault of the encoder tracks: {}\n", configuration.names[i],
               backend.lost_edges(i), name_of(backend.last_encoder_fault(i)));
  return status_of(result);
}

int run_modbus(RealTime& real_time, const DriveConfiguration& configuration, const DriveOptions& options,
               RunRecord& record) {
  const auto& setup = configuration.setup;
  if (!setup.modbus_client)
    throw StartRefused(fmt::format("{}: found no table [drive.modbus_client]; expected one with the device",
                                   configuration.machine.id));
  for (const auto& axis : configuration.machine.axes)
    if (axis.motor.model == machine::MotorModel::synchronous)
      throw StartRefused(
          fmt::format("{}: found axis {} with a synchronous motor; expected a motor with one voltage (\"dc\" or "
                      "\"force\"), as Modbus carries one per axis",
                      configuration.machine.id, axis.name));
  const auto config = modbus_client_config(configuration.machine, setup);
  hal::check(modbus_client_budget(config));
  const double period = configuration.machine.timing.fast_period;
  if (config.period > period * 1.001)
    throw StartRefused(
        fmt::format("{}: found timing.fast_period = {:g} ms and drive.modbus_client.period = {:g} ms; expected a "
                    "fast_period of at least that period",
                    configuration.machine.id, period * 1e3, config.period * 1e3));
  hal::TickClock clock(configuration.period_ns);
  hal::ModbusClient client(config);
  hal::ModbusBackend backend(client, clock);
  return status_of(run(real_time, backend, &clock, configuration, options, "modbus " + config.device, record));
}

int print_budgets(const DriveConfiguration& configuration) {
  std::vector<hal::BusBudget> budgets;
  if (configuration.setup.can) budgets.push_back(can_bus_budget(configuration));
  if (configuration.setup.can_server && can_server_identifiers(configuration).empty())
    budgets.push_back(can_server_budget(configuration));
  if (configuration.setup.modbus_client)
    budgets.push_back(modbus_client_budget(modbus_client_config(configuration.machine, configuration.setup)));
  if (budgets.empty())
    throw StartRefused("found no bus; expected [drive.can], [drive.can_server] or [drive.modbus_client]");
  bool refused = false;
  for (const auto& budget : budgets) {
    fmt::print("{}", hal::budget_table(budget));
    refused |= !budget.rejection_reasons.empty();
  }
  return refused ? exit_refused : exit_done;
}

// On the machine itself: the chip's device is looked up.
int print_udev_rules(const DriveConfiguration& configuration) {
  const auto& gpio = configuration.setup.gpio;
  if (!gpio) throw StartRefused("found no table [drive.gpio]; expected one with the chip that the rules are for");
  fmt::print("{}", udev_rules(*gpio, hal::chip_name(gpio->chip), "/sys"));
  return exit_done;
}

// What a killed run left: to have the lines and to give them back makes them inactive and stops the PWM.
int put_to_rest(const DriveConfiguration& configuration, const DriveOptions& options) {
  const auto& [setup, machine] = std::tie(configuration.setup, configuration.machine);
  if (options.hal == "gpio") {
    const hal::GpioBackend backend(gpio_configuration(setup, machine, true), configuration.period_ns);
  } else if (options.hal == "can" && has_gpio_lines(setup, machine)) {
    hal::Lines lines(setup.gpio->chip, input_bias(setup));
    const hal::GpioInputsOutputs io(lines, gpio_lines(setup, machine), {}, track_lines(setup));
  }
  return exit_done;
}

int serve(const DriveOptions& options) {
  hal::install_signal_reactions(RunRecord::note_signal);
  if (options.faults) {
    fmt::print("{}", fault_page());
    return exit_done;
  }
  if (options.modbus_registers) {
    fmt::print("{}", modbus_register_page());
    return exit_done;
  }
  if (options.canopen_objects || options.eds) {
    fmt::print("{}", options.eds ? eds_text() : object_page());
    return exit_done;
  }
  if (options.machine.empty())
    throw StartRefused("found no --machine; expected a machine file or a shipped machine's name");
  const auto configuration = read_configuration(options);
  if (options.budget) return print_budgets(configuration);
  if (options.udev) return print_udev_rules(configuration);
  if (options.dbc) {
    fmt::print("{}", dbc_page(configuration));
    return exit_done;
  }
  if (options.check_realtime) {
    const auto& real_time = configuration.setup.real_time;
    fmt::print("{}", text_of(check_real_time("/", real_time.cpu)));
    constexpr std::uint64_t ticks = 160000;
    const auto measured =
        measure_jitter(configuration.period_ns, ticks, {.priority = real_time.priority, .cpu = real_time.cpu});
    fmt::print("{}", text_of(measured, configuration.period_ns));
    return exit_done;
  }
  if (options.rest) return put_to_rest(configuration, options);
  check_remote(configuration);
  cam_of(options, configuration);  // refused before anything is opened
  const auto& wanted = configuration.setup.real_time;
  RealTime real_time({.priority = wanted.priority, .cpu = wanted.cpu});
  real_time.prepare_process();
  check_room(options, configuration, !any_refused(real_time.steps()));
  RunRecord record(options.parameters);
  if (options.hal == "can") return run_can(real_time, configuration, options, record);
  if (options.hal == "gpio") return run_gpio(real_time, configuration, options, record);
  if (options.hal == "modbus") return run_modbus(real_time, configuration, options, record);
  return run_simulated(real_time, configuration, options, record);
}

}  // namespace
}  // namespace stiction::drive

int main(int argc, char** argv) {
  return stiction::hal::run_program<stiction::drive::DriveOptions>(
      argc, argv,
      {"stictiond", "the drive: closes the loops of a machine's axes over its buses", stiction::program_version},
      stiction::drive::serve);
}
