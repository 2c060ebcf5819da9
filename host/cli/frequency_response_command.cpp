#include "host/cli/frequency_response_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/units.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/experiment_result_output.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/report_origin.hpp"
#include "host/cli/response_test_output.hpp"
#include "host/log/csv_log.hpp"
#include "host/log/own_units.hpp"
#include "host/log/read_log.hpp"
#include "host/log/shown_units.hpp"
#include "host/output/experiment_output.hpp"
#include "host/response/response_result.hpp"
#include "host/simulate/expected_figures.hpp"
#include "host/simulate/frequency_response.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

struct Options {
  MachineOptions machine;
  std::string friction, axis, loop, speed, amplitude, lowest = "2 Hz", signal = "multisine";
  int periods = 2, passes = 8;
  std::string from, columns, log, out;
  bool json = false;
};

constexpr std::array<const char*, 3> loop_names{"current", "velocity", "position"};

double quantity(const char* option, const std::string& text, const char* unit, const char* example) {
  try {
    const double value = machine::parse_quantity(text, unit);
    if (value > 0.0) return value;
  } catch (const machine::UnitError& error) {
    throw UsageError(fmt::format("{}: found '{}' ({}); expected {}", option, text, error.what(), example));
  }
  throw UsageError(fmt::format("{}: found '{}'; expected a value above zero, {}", option, text, example));
}

std::vector<std::string> loops_of(const std::string& text) {
  if (text.empty() || text == "all") return {};
  const auto names = split_list(text);
  for (const auto& name : names)
    require_known("--loop", name, "all, or some of", {loop_names.begin(), loop_names.end()});
  return names;
}

// Keeps the axes that --axis names, in the machine's order.
void choose_axes(machine::Machine& machine, const std::string& text) {
  if (text.empty()) return;
  const auto names = split_list(text);
  for (const auto& name : names) require_known("--axis", name, "axes of " + machine.id, axis_names(machine));
  std::erase_if(machine.axes,
                [&](const auto& axis) { return std::find(names.begin(), names.end(), axis.name) == names.end(); });
}

// What all axes do at the same time is a motion of linear axes.
void require_one_kind(const machine::Machine& machine) {
  for (const auto& axis : machine.axes)
    if (axis.coordinate.rotary() && machine.axes.size() > 1)
      throw UsageError(fmt::format("--axis: found {} axes, of which {} is rotary; expected linear axes, or one alone",
                                   machine.axes.size(), axis.name));
}

// m/s
double speed_of(const Options& options, const machine::Machine& machine) {
  const auto& coordinate = machine.axes.front().coordinate;
  const auto own = coordinate.own("m/s");
  const double speed =
      own.to_linear(quantity("--speed", options.speed, std::string(own.unit).c_str(),
                             coordinate.rotary() ? "a speed such as \"60 deg/s\"" : "a speed such as \"2 m/min\""));
  const auto feed = ShownUnits(coordinate).feed;
  for (const auto& axis : machine.axes)
    if (speed > axis.max_velocity)
      throw UsageError(fmt::format("--speed: found '{}'; expected at most {:.3g} {}, the limit of axis {}",
                                   options.speed, feed(axis.max_velocity), feed.unit, axis.name));
  return speed;
}

FrequencyResponsePlan plan_of(const Options& options, const machine::Machine& machine) {
  FrequencyResponsePlan plan;
  plan.machine = machine;
  const auto friction = friction_models(options.friction, machine);
  if (friction.size() != 1) throw UsageError(fmt::format("--friction: found {} models; expected one", friction.size()));
  if (!options.friction.empty())
    for (auto& axis : plan.machine.axes) axis.friction.use = friction.front();
  plan.signal = options.signal == "multisine" ? TestSignal::multisine : TestSignal::stepped_sine;
  if (!options.speed.empty()) plan.speed = speed_of(options, machine);
  if (!options.amplitude.empty()) {
    const bool force = machine.axes.front().motor.driven_by_volts();
    plan.amplitude =
        quantity("--amplitude", options.amplitude, force ? "V" : "A",
                 force ? "a voltage such as \"1 V\", as the motor is a force source" : "a current such as \"3 A\"");
  }
  plan.lowest = quantity("--lowest", options.lowest, "Hz", "a frequency such as \"2 Hz\"");
  if (plan.lowest > 50.0 || plan.lowest < 0.05)
    throw UsageError(fmt::format("--lowest: found '{}'; expected 0.05 Hz to 50 Hz", options.lowest));
  if (options.periods < 2)
    throw UsageError(fmt::format(
        "--periods: found {}; expected at least 2, as the coherence follows from their difference", options.periods));
  if (options.passes < 1) throw UsageError(fmt::format("--passes: found {}; expected at least 1", options.passes));
  plan.periods = options.periods;
  plan.passes = options.passes;
  if (!plan.speed) plan.speed = usual_speed(plan);
  return plan;
}

struct Measurement {
  std::vector<AxisResponse> responses;
  ResponseText text;
  double period = 0.0;  // s, of the log
};

Measurement simulated(const Options& options, const machine::Machine& machine) {
  require_one_kind(machine);
  const auto plan = plan_of(options, machine);
  const auto feed = ShownUnits(machine.axes.front().coordinate).feed;
  const auto log = run_frequency_response(plan);
  if (!options.log.empty()) {
    PendingFile file(options.log);
    file.write(csv_log_text(log));
    file.commit();
  }
  Measurement m;
  for (std::size_t k = 0; k < plan.machine.axes.size(); ++k)
    m.responses.push_back(axis_response(log, as_linear(log.axes[k], plan.machine.axes[k].coordinate),
                                        plan.machine.timing, plan.machine.axes[k]));
  std::vector<std::string> friction;
  for (const auto& axis : plan.machine.axes) friction.push_back(axis.name + " " + axis.friction.use);
  m.text = {FixedSignals::name,
            fmt::format("Simulated: {} added to the set current while the axis moves back and forth at {:.3g} {}; "
                        "friction model {}.",
                        plan.signal == TestSignal::multisine ? "multisine" : "one sine after the other",
                        feed(*plan.speed), feed.unit, fmt::join(friction, ", ")),
            true};
  return m;
}

// The machine's axis to which this axis of the log belongs; none: --axis leaves it out.
const machine::AxisModel* axis_for(const Log& log, const AxisLog& measured, const machine::Machine& machine,
                                   bool chosen) {
  for (const auto& axis : machine.axes)
    if (axis.name == measured.axis) return &axis;
  if (measured.axis.empty() && machine.axes.size() == 1) return &machine.axes.front();
  if (!measured.axis.empty() && chosen) return nullptr;
  std::vector<std::string> known;
  for (const auto& axis : machine.axes) known.push_back(axis.name);
  throw UsageError(measured.axis.empty()
                       ? fmt::format("{}: found columns without an axis; expected --axis with one of {}", log.source,
                                     fmt::join(known, ", "))
                       : fmt::format("{}: found axis {}; expected axes of {}: {}", log.source, measured.axis,
                                     machine.id, fmt::join(known, ", ")));
}

Measurement measured(const Options& options, const machine::Machine& machine) {
  const auto log = read_log_shown(options.from, options.columns);
  Measurement m;
  m.period = log.period;
  bool any_test = false;
  for (const auto& axis : log.axes) any_test = any_test || !axis.i_inject.empty() || !axis.u_inject.empty();
  for (const auto& axis : log.axes) {
    const auto* of_machine = axis_for(log, axis, machine, !options.axis.empty());
    // An axis without a test signal is no error beside one that has it.
    if (of_machine == nullptr || (any_test && axis.i_inject.empty() && axis.u_inject.empty())) continue;
    require_same_kind(log, axis, *of_machine);
    m.responses.push_back(axis_response(log, as_linear(axis, of_machine->coordinate), machine.timing, *of_machine));
  }
  if (m.responses.empty())
    throw UsageError(
        fmt::format("{}: found no axis of --axis '{}' with a test signal; expected i_inject[A] or "
                    "u_inject[V] of it",
                    options.from, options.axis));
  m.text = {"measured", fmt::format("Measured: {}.", log.source), false};
  return m;
}

void run(const Options& options, const Invocation& invocation) {
  if (is_response_test_file(options.from)) {
    if (!options.out.empty() || !options.axis.empty() || !options.loop.empty())
      throw UsageError(fmt::format(
          "--from: found {}, the response test of a control, together with --out, --axis or --loop; expected "
          "it alone or with --json, as it is a response of its own",
          options.from));
    print_response_test(options.from, options.json);
    return;
  }
  if (options.machine.machine.empty())
    throw UsageError(
        "--machine: found none; expected a shipped machine by name, or a machine file (only the response test of a "
        "control, --from FILE.XML, needs none)");
  auto machine = options.machine.load(options.machine.machine, "frequency-response");
  choose_axes(machine, options.axis);
  const auto loops = loops_of(options.loop);
  for (const auto& loop : loops)
    require_needs(machine, needs_of("frequency-response --loop " + loop),
                  machine::find_machine(options.machine.machine));
  sim::ExperimentResult result;
  auto origin = report_origin(options.machine.machine);
  try {
    const auto m = during("measuring the loops", [&] {
      return options.from.empty() ? simulated(options, machine) : measured(options, machine);
    });
    if (!options.from.empty()) origin.sources = {options.from}, origin.sample_periods = {m.period};
    result = response_result(m.responses, machine, loops, m.text);
    if (options.from.empty()) add_expected_figures(result, machine, {}, loops.empty());
  } catch (const ResponseError& error) {
    throw UsageError(error.what());
  } catch (const LogError& error) {
    throw UsageError(error.what());
  }
  const auto json = experiment_json(result, machine);
  write_experiment_folder(options.out, invocation, machine, result, origin, json);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  print_experiment(result, machine, written(options.log), options.out);
}

}  // namespace

void add_frequency_response(CLI::App& simulate, const Invocation& invocation) {
  auto* command = simulate.add_subcommand("frequency-response",
                                          "measure current, velocity and position loop and the plant with a test "
                                          "signal on the set current: Bode plots and margins");
  auto o = std::make_shared<Options>();
  o->machine.add_to(*command, "shipped machine by name, or a machine file; required but for a response test");
  command->get_option("--machine")->required(false);
  command->add_option("--axis", o->axis, "axis, or a list of axes [all]")->type_name("AXIS");
  command
      ->add_option("--loop", o->loop,
                   "loop to measure: current, velocity, position, or a list of them [all, with the plant]")
      ->type_name("LOOP");
  auto* from =
      command
          ->add_option(
              "--from", o->from,
              "evaluate this log instead, which must have i_inject[A] or u_inject[V], or the response test (XML) of "
              "a SINUMERIK")
          ->type_name("LOG");
  add_columns(*command, o->columns)->needs(from);
  const auto simulated_only = [&](CLI::Option* option) { return option->excludes(from); };
  simulated_only(command->add_option("--friction", o->friction, "friction model [as in the machine file]"))
      ->type_name("MODEL");
  simulated_only(command->add_option("--signal", o->signal, "multisine: all frequencies at once; stepped-sine"))
      ->check(one_of({"multisine", "stepped-sine"}))
      ->capture_default_str();
  simulated_only(
      command->add_option("--speed", o->speed,
                          "speed of the axis, which moves back and forth during the test [2 m/min; of a rotary axis a "
                          "third of its highest speed, or what its travel allows]"))
      ->type_name("\"NUMBER UNIT\"");
  simulated_only(
      command->add_option("--amplitude", o->amplitude, "peak value of the test signal [10 % of the current limit]"))
      ->type_name("\"NUMBER UNIT\"");
  simulated_only(
      command->add_option("--lowest", o->lowest, "lowest frequency, and spacing of the lines of a multisine"))
      ->type_name("\"NUMBER UNIT\"")
      ->capture_default_str();
  simulated_only(
      command->add_option("--periods", o->periods, "number of evaluated periods, at least 2, after one for settling"))
      ->capture_default_str();
  simulated_only(
      command->add_option("--passes", o->passes, "number of passes of a multisine, each with different phases"))
      ->capture_default_str();
  simulated_only(add_output_file(*command, "--log", o->log, "write the signals that a drive would record (CSV)"));
  add_out(*command, o->out, "write report.html and result.json into this folder");
  command->add_flag("--json", o->json, "print the result as JSON on standard output");
  command->callback([o, &invocation] { run(*o, invocation); });
}

}  // namespace stiction::host
