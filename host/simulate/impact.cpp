// Impact compliance of the position loop (Mendricky 2006, 6.2): a step of external force on an axis at standstill.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/log/shown_units.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/log_recorder.hpp"
#include "host/simulate/parabolic_chatter.hpp"
#include "sim/plant/friction/parabolic.hpp"
#include "sim/plant/friction/parameters.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double step_time = 0.01;     // s
constexpr double most_force = 1500.0;  // N, half the continuous force of the source's motor
constexpr double force_share = 0.25;   // of the largest force of a different motor: it holds that with ease
constexpr double duration = 1.0;       // s
constexpr double holding = 1.0;        // s before that in which a weight is taken up
constexpr double finest_back = 1e-6;   // m, of a rotary axis rad
constexpr double shown = 0.15;         // s, of a response that has returned by then

double step_force_on(const machine::AxisModel& axis) {
  const double force = force_share * machine::largest_force(axis);
  return axis.coordinate.rotary() ? force : std::min(most_force, force);
}

double holding_of(const machine::AxisModel& axis) { return axis.gravity ? holding : 0.0; }

// The deviation (m) that counts as returned: one that the position controller sees.
double back_on(const machine::AxisModel& axis) {
  const double seen = std::max(axis.encoder.increment, axis.position_controller.increment);
  return std::max(axis.coordinate.own("m").to_linear(finest_back), seen);
}

struct Response {
  sim::Series deviation, force, friction;
  double peak = 0.0;            // m
  double last_beyond = 0.0;     // s after the step, the last time the deviation was above back_on()
  double resting_friction = 0;  // N
  bool returned() const { return last_beyond < duration - step_time - 1e-3; }
};

template <class S>
Response respond(const machine::Machine& machine, const std::string& name, double step_force,
                 const TraceSink<S>& trace) {
  const auto& axis = machine.axes.front();
  const ShownUnits own(axis.coordinate);
  const double back = back_on(axis);
  Response r;
  r.deviation.name = r.force.name = r.friction.name = name;
  r.deviation.friction = r.force.friction = r.friction.friction = name;
  const std::array<double, 1> origin{0.0};
  ControlRun<S> run(machine, origin);
  const std::array<sim::AxisSetPoint, 1> standstill{};
  const double begin = holding_of(axis);
  while (run.time() < begin) run.tick(standstill);
  while (run.time() < begin + duration) {
    const double t = run.time() - begin;
    auto& plant = run.plant(0);
    plant.set_external_force(t >= step_time ? step_force : 0.0);
    const double force = plant.motor_force();
    const double friction = plant.friction_force();
    run.tick(standstill, trace);
    const double deviation = -machine::to_si(run.signals(0).e);
    r.deviation.x.push_back(t * 1e3);
    r.deviation.y.push_back(own.deviation(deviation));
    r.force.x.push_back(t * 1e3);
    r.force.y.push_back(own.force(force));
    r.friction.x.push_back(t * 1e3);
    r.friction.y.push_back(own.force(friction));
    r.peak = std::max(r.peak, std::abs(deviation));
    if (std::abs(deviation) > back) r.last_beyond = t - step_time;
    r.resting_friction = friction;
  }
  return r;
}

constexpr double finest_step = 62.5e-6;  // s, of the friction that is evaluated explicitly

// The chatter that the source saw with B2: at its step, at the drive's tick, and with the implicit step of the plant.
void add_chatter(const machine::Machine& machine, double step_force, sim::ExperimentResult& result) {
  const auto& axis = machine.axes.front();
  if (!axis.friction.models.contains(std::string(sim::Parabolic<>::name))) return;
  const auto parameters = sim::parameters_of<sim::Parabolic<>>(axis.friction);
  const ShownUnits own(axis.coordinate);
  // A step cannot be finer than the drive's tick, and friction without a root has a slope at standstill.
  if (machine.timing.fast_period > finest_step || !(parameters.order > 1.0)) return;
  sim::Chart chart{"B2 evaluated explicitly and implicitly",
                   "time since 500 ms, ms",
                   fmt::format("friction {}, {}", own.force_word, own.force.unit),
                   "Half a second after the force step: the same law on the same machine, evaluated explicitly every "
                   "0.2 ms, explicitly every 62.5 us, and implicitly.",
                   false,
                   {}};
  struct Case {
    const char* key;
    const char* text;
    std::optional<double> step;
  };
  for (const Case& c : {Case{"200_us", "explicit, 0.2 ms", 200e-6}, Case{"62.5_us", "explicit, 62.5 us", finest_step},
                        Case{"implicit", "implicit", std::nullopt}}) {
    auto r = impact_with_parabolic_friction(machine, step_force, step_time, c.step);
    r.friction.name = c.text;
    for (double& y : r.friction.y) y = own.force(y);
    if (c.step && *c.step > 100e-6) {
      const double amplitude = chatter_amplitude(parameters, axis.mass, *c.step);
      const auto add = [&](const char* name, const char* text, double value) {
        result.figures.push_back(
            {name, own.force.unit, std::string("B2 at rest, ") + text + ", explicit, 0.2 ms", own.force(value), {}});
      };
      add("chatter_amplitude_200_us", "rms of the friction", r.rms);
      add("chatter_formula_200_us", "the same by a^(n/(n-1)) (h/2m)^(1/(n-1))", amplitude);
      add("chatter_least_200_us", "least friction", r.least);
      add("chatter_greatest_200_us", "greatest friction", r.greatest);
      result.findings.push_back(fmt::format(
          "parabolic, evaluated explicitly every 0.2 ms, alternates between {:.3g} {unit} and {:+.3g} {unit}, {:.3g} "
          "{unit} rms; the formula with step and {} gives {:.3g} {unit}. This is an artefact of the step: the implicit "
          "step shows none.",
          own.force(r.least), own.force(r.greatest), own.force(r.rms), axis.coordinate.rotary() ? "inertia" : "mass",
          own.force(amplitude), fmt::arg("unit", own.force.unit)));
    }
    result.figures.push_back({std::string("chatter_alternations_") + c.key,
                              "%",
                              std::string("B2 at rest, evaluations at which the friction changes its sign, ") + c.text,
                              r.alternating * 100.0,
                              {}});
    chart.series.push_back(std::move(r.friction));
  }
  result.charts.push_back(std::move(chart));
}

template <class S>
sim::ExperimentResult impact_with(const ExperimentInput& input) {
  auto machine = input.machine;
  auto& axis = machine.axes.front();
  const double step_force = step_force_on(axis);
  const ShownUnits own(axis.coordinate);
  const auto step = fmt::format("{:.4g} {}", own.force(step_force), own.force.unit);
  const auto back = fmt::format("{:.3g} {}", own.deviation(back_on(axis)), own.deviation.unit);
  const auto* word = own.force_word;
  sim::ExperimentResult result{
      "impact",
      "Impact compliance",
      S::name,
      fmt::format("A step of {} on axis {} at standstill, in position control: how far does the axis give way, "
                  "when is it back, and what friction is left at rest? Models that can stick stay wound up, the others "
                  "relax to zero (Mendricky 2006, 6.2).",
                  step, axis.name),
      {},
      {},
      {}};
  sim::Chart deviation{"Deviation",
                       "time, ms",
                       fmt::format("deviation at the encoder, {}", own.deviation.unit),
                       fmt::format("External {} of {} from 10 ms on.", word, step),
                       false,
                       {}};
  sim::Chart force{
      fmt::format("Motor {}", word),
      "time, ms",
      fmt::format("motor {}, {}", word, own.force.unit),
      fmt::format("At rest motor and friction share the {}{}.", step, axis.gravity ? " and the weight" : ""),
      false,
      {}};
  sim::Chart friction{"Friction", "time, ms", fmt::format("friction {}, {}", word, own.force.unit), "", false, {}};
  const bool integral =
      axis.cascaded() ? axis.velocity_controller.integral_time.has_value() : axis.controller->integral_time.has_value();
  const auto* without_integral = integral          ? ""
                                 : axis.cascaded() ? "; the velocity controller has no integral part"
                                                   : "; the controller has no integral part";
  bool all_returned_soon = true;
  for (const auto& name : input.friction) {
    axis.friction.use = name;
    LogRecorder recorder(machine);
    auto r = respond<S>(machine, name, step_force, input.keep_log ? recorder.sink<S>() : TraceSink<S>{});
    all_returned_soon = all_returned_soon && step_time + r.last_beyond < shown;
    if (input.keep_log) {
      auto log = recorder.take();
      for (const double t : log.t)
        log.axes[0].external_force.push_back(t - holding_of(axis) >= step_time ? own.force(step_force) : 0.0);
      input.keep_log("", std::move(log));
    }
    const auto add = [&](const char* figure, const char* unit, const std::string& text, double value) {
      result.figures.push_back(
          sim::of_model({figure + ("_" + name), unit, fmt::format("{}, {}", text, name), value, {}}, name));
    };
    add("peak_deviation", own.deviation.unit, "peak deviation", own.deviation(r.peak));
    if (r.returned())
      add("return_time", "ms", "back within " + back + " after", r.last_beyond * 1e3);
    else
      result.findings.push_back(
          fmt::format("{}: not back within {} after {:.3g} s{}.", name, back, duration - step_time, without_integral));
    add("resting_friction", own.force.unit, "friction left at rest", own.force(std::abs(r.resting_friction)));
    deviation.series.push_back(std::move(r.deviation));
    force.series.push_back(std::move(r.force));
    friction.series.push_back(std::move(r.friction));
  }

  result.charts = {std::move(deviation), std::move(force), std::move(friction)};
  if (all_returned_soon)
    for (auto& chart : result.charts) chart.x_range = {0.0, shown * 1e3};
  if (axis.cascaded() && std::find(input.friction.begin(), input.friction.end(), "parabolic") != input.friction.end())
    add_chatter(machine, step_force, result);
  return result;
}

}  // namespace

sim::ExperimentResult run_impact(const ExperimentInput& input) {
  const bool firmware = input.machine.axes.front().cascaded() && input.machine.fits_formats();
  return firmware ? impact_with<FixedSignals>(input) : impact_with<machine::DoubleSignals>(input);
}

}  // namespace stiction::host
