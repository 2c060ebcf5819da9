#include "host/simulate/circle_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>
#include <thread>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/configuration/trace_writer.hpp"
#include "host/simulate/friction_choice.hpp"
#include "host/simulate/log_recorder.hpp"
#include "sim/experiment/circle_measurement.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr int learning_laps = 4;

bool learns(const machine::Machine& machine) {
  return std::any_of(machine.axes.begin(), machine.axes.end(), [](const machine::AxisModel& axis) {
    return axis.friction_compensation && axis.friction_compensation->use == CompensationKind::learning;
  });
}

sim::CircleRun run_case(const CircleCase& c) {
  return c.signals == SignalKind::fixed_point ? run_circle<FixedSignals>(c.machine, c.settings)
                                              : run_circle<machine::DoubleSignals>(c.machine, c.settings);
}

template <class S>
sim::CircleRun run_into(const CircleCase& c, machine::TraceWriter& writer) {
  return run_circle<S>(c.machine, c.settings,
                       [&](std::int64_t now_ns, std::span<const AxisSignals<S>> s) { writer.write(now_ns, s); });
}

void join_directions(std::vector<sim::CircleRun>& runs) {
  for (std::size_t i = 0; i + 1 < runs.size(); i += 2) {
    const auto both = sim::bidirectional_errors(runs[i], runs[i + 1]);
    runs[i].both_directions = both;
    runs[i + 1].both_directions = both;
  }
}

}  // namespace

std::vector<CircleCase> cases_of(const CirclePlan& plan) {
  std::vector<CircleCase> cases;
  for (const auto& friction : plan.friction)
    for (const double feed : plan.feeds)
      for (const auto direction : plan.directions) {
        CircleCase c{plan.machine, circle_settings(plan.machine, feed, plan.radius), plan.signals};
        use_friction(c.machine, friction);
        c.settings.direction = direction;
        if (learns(c.machine)) c.settings.laps_before = learning_laps;
        check_circle(c.machine, c.settings);
        cases.push_back(std::move(c));
      }
  return cases;
}

sim::CircleResult run_circles(const CirclePlan& plan, const std::function<void()>& done) {
  const auto cases = cases_of(plan);
  std::vector<std::optional<sim::CircleRun>> runs(cases.size());
  std::vector<std::exception_ptr> failures(cases.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size(); i = next++) {
      try {
        runs[i] = run_case(cases[i]);
      } catch (...) {
        failures[i] = std::current_exception();
      }
      try {
        if (done) done();
      } catch (...) {
        next = cases.size();
        if (!failures[i]) failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k) workers.emplace_back(work);
    work();
  }

  sim::CircleResult result;
  result.signals = plan.signals == SignalKind::fixed_point ? FixedSignals::name : machine::DoubleSignals::name;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (failures[i]) {
      try {
        std::rethrow_exception(failures[i]);
      } catch (const FaultTripped& fault) {
        throw CaseFailed(fault, cases[i]);
      }
    }
    result.runs.push_back(std::move(*runs[i]));
  }
  if (plan.directions.size() == 2 && result.runs.front().is_circle()) join_directions(result.runs);
  return result;
}

sim::CircleRun run_traced(const CircleCase& c, const std::filesystem::path& file) {
  const bool fixed = c.signals == SignalKind::fixed_point;
  std::vector<std::string> comments{
      c.machine.axes.size() == 2 ? "log: stiction simulate circle"
                                 : "log: stiction simulate circle, a sine of one axis",
      fmt::format("machine: {}", c.machine.name),
      fmt::format("friction: {}", friction_in_use(c.machine)),
      fmt::format("feed: {:g} m/min", c.settings.feed * 60.0),
      fmt::format("radius: {:g} mm", c.settings.radius * 1e3),
      fmt::format("direction: {}", c.settings.direction == sim::Direction::clockwise ? "cw" : "ccw"),
      fmt::format("signals: {}", fixed ? FixedSignals::name : machine::DoubleSignals::name)};
  std::vector<std::string> axes;
  std::vector<bool> force_sources;
  for (const auto& axis : c.machine.axes) {
    axes.push_back(axis.name);
    force_sources.push_back(axis.motor.driven_by_volts());
  }
  if (std::find(force_sources.begin(), force_sources.end(), false) != force_sources.end())
    comments.emplace_back("current: amplitude (peak) amperes");
  machine::TraceWriter writer(file, axes, comments, force_sources);
  std::optional<sim::CircleRun> run;
  std::exception_ptr fault;
  try {
    run = fixed ? run_into<FixedSignals>(c, writer) : run_into<machine::DoubleSignals>(c, writer);
  } catch (const FaultTripped&) {
    fault = std::current_exception();
  }
  writer.close();
  if (fault) std::rethrow_exception(fault);
  return *run;
}

Log run_logged(const CircleCase& c) {
  LogRecorder recorder(c.machine);
  if (c.signals == SignalKind::fixed_point)
    run_circle<FixedSignals>(c.machine, c.settings, recorder.sink<FixedSignals>());
  else
    run_circle<machine::DoubleSignals>(c.machine, c.settings, recorder.sink<machine::DoubleSignals>());
  return recorder.take();
}

}  // namespace stiction::host
