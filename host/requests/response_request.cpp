#include "host/requests/response_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "firmware/machine/file/units.hpp"
#include "host/log/own_units.hpp"
#include "host/log/read_log.hpp"
#include "host/log/shown_units.hpp"
#include "host/requests/names.hpp"
#include "host/requests/run_options.hpp"
#include "host/requests/usage_error.hpp"
#include "host/response/response_result.hpp"
#include "host/simulate/expected_figures.hpp"
#include "host/simulate/frequency_response.hpp"
#include "host/simulate/machine_needs.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr std::array<const char*, 3> response_loops{"current", "velocity", "position"};

double response_quantity(const char* option, const std::string& text, const char* unit, const char* example) {
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
    require_known("--loop", name, "all, or some of", {response_loops.begin(), response_loops.end()});
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
double speed_of(const ResponseRequest& request, const machine::Machine& machine) {
  const auto& coordinate = machine.axes.front().coordinate;
  const auto own = coordinate.own("m/s");
  const double speed = own.to_linear(
      response_quantity("--speed", request.speed, std::string(own.unit).c_str(),
                        coordinate.rotary() ? "a speed such as \"60 deg/s\"" : "a speed such as \"2 m/min\""));
  const auto feed = ShownUnits(coordinate).feed;
  for (const auto& axis : machine.axes)
    if (speed > axis.max_velocity)
      throw UsageError(fmt::format("--speed: found '{}'; expected at most {:.3g} {}, the limit of axis {}",
                                   request.speed, feed(axis.max_velocity), feed.unit, axis.name));
  return speed;
}

FrequencyResponsePlan response_plan(const ResponseRequest& request, const machine::Machine& machine) {
  FrequencyResponsePlan plan;
  plan.machine = machine;
  const auto friction = friction_models(request.friction, machine);
  if (friction.size() != 1) throw UsageError(fmt::format("--friction: found {} models; expected one", friction.size()));
  if (!request.friction.empty())
    for (auto& axis : plan.machine.axes) axis.friction.use = friction.front();
  plan.signal = request.signal == "multisine" ? TestSignal::multisine : TestSignal::stepped_sine;
  if (!request.speed.empty()) plan.speed = speed_of(request, machine);
  if (!request.amplitude.empty()) {
    const bool force = machine.axes.front().motor.driven_by_volts();
    plan.amplitude = response_quantity(
        "--amplitude", request.amplitude, force ? "V" : "A",
        force ? "a voltage such as \"1 V\", as the motor is a force source" : "a current such as \"3 A\"");
  }
  plan.lowest = response_quantity("--lowest", request.lowest, "Hz", "a frequency such as \"2 Hz\"");
  if (plan.lowest > 50.0 || plan.lowest < 0.05)
    throw UsageError(fmt::format("--lowest: found '{}'; expected 0.05 Hz to 50 Hz", request.lowest));
  if (request.periods < 2)
    throw UsageError(fmt::format(
        "--periods: found {}; expected at least 2, as the coherence follows from their difference", request.periods));
  if (request.passes < 1) throw UsageError(fmt::format("--passes: found {}; expected at least 1", request.passes));
  plan.periods = request.periods;
  plan.passes = request.passes;
  if (!plan.speed) plan.speed = usual_speed(plan);
  return plan;
}

struct Measurement {
  std::vector<AxisResponse> responses;
  ResponseText text;
  double period = 0.0;  // s, of the log
};

Measurement simulated_responses(const ResponseRequest& request, const machine::Machine& machine,
                                const ResponseHooks& hooks) {
  require_one_kind(machine);
  const auto plan = response_plan(request, machine);
  const auto feed = ShownUnits(machine.axes.front().coordinate).feed;
  const auto log = run_frequency_response(plan);
  if (hooks.simulated) hooks.simulated(log);
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

Measurement measured_responses(const ResponseRequest& request, const machine::Machine& machine,
                               const ResponseHooks& hooks) {
  const auto log = hooks.read(request.from, request.columns);
  Measurement m;
  m.period = log.period;
  bool any_test = false;
  for (const auto& axis : log.axes) any_test = any_test || !axis.i_inject.empty() || !axis.u_inject.empty();
  for (const auto& axis : log.axes) {
    const auto* of_machine = axis_for(log, axis, machine, !request.axis.empty());
    // An axis without a test signal is no error beside one that has it.
    if (of_machine == nullptr || (any_test && axis.i_inject.empty() && axis.u_inject.empty())) continue;
    require_same_kind(log, axis, *of_machine);
    m.responses.push_back(axis_response(log, as_linear(axis, of_machine->coordinate), machine.timing, *of_machine));
  }
  if (m.responses.empty())
    throw UsageError(
        fmt::format("{}: found no axis of --axis '{}' with a test signal; expected i_inject[A] or "
                    "u_inject[V] of it",
                    request.from, request.axis));
  m.text = {"measured", fmt::format("Measured: {}.", log.source), false};
  return m;
}

}  // namespace

Responded response_request(const ResponseRequest& request, machine::Machine machine, const std::filesystem::path& file,
                           const ResponseHooks& hooks) {
  require_known("--signal", request.signal, "one of", {"multisine", "stepped-sine"});
  choose_axes(machine, request.axis);
  const auto loops = loops_of(request.loop);
  for (const auto& loop : loops)
    if (const auto missing = what_is_missing(machine, needs_of("frequency-response --loop " + loop)))
      throw UsageError(fmt::format("{}: {}", file.string(), *missing));
  Responded responded{std::move(machine), {}};
  try {
    const auto m = request.from.empty() ? simulated_responses(request, responded.machine, hooks)
                                        : measured_responses(request, responded.machine, hooks);
    responded.period = m.period;
    responded.result = response_result(m.responses, responded.machine, loops, m.text);
    if (request.from.empty()) add_expected_figures(responded.result, responded.machine, {}, loops.empty());
  } catch (const ResponseError& error) {
    throw UsageError(error.what());
  } catch (const LogError& error) {
    throw UsageError(error.what());
  }
  return responded;
}

}  // namespace stiction::host
