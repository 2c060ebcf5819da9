// Constant velocity (Mendricky 2006, 6.1): current or voltage at constant speeds, compared with the measured one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/model/motor_force.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/log_recorder.hpp"
#include "sim/experiment/speed_ramp.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// One speed, and what drove the real axis at it.
struct Point {
  double speed;                    // m/s
  std::optional<double> measured;  // A or V
};

constexpr double settling = 0.4, averaging = 0.1;  // s

// The start of the source's motions (Tab 6.2), as far as the axis can.
sim::SpeedRamp start_of(const machine::AxisModel& axis, double speed) {
  const double acceleration = std::min(2.0, axis.max_acceleration);
  return {speed, acceleration, 20.0 * acceleration};
}

bool can_drive(const machine::AxisModel& axis, double speed) {
  const auto start = start_of(axis, speed);
  return speed <= axis.max_velocity && start.at(start.duration() + settling + averaging).distance <= axis.travel;
}

// Mean motor force over the force constant (A, or V of a force source) over the last 0.1 s of a run at `speed` (m/s);
// the start has died out by then.
double steady_effort(const machine::Machine& machine, double speed, const TraceSink<FixedSignals>& trace) {
  const auto& axis = machine.axes.front();
  const auto ramp = start_of(axis, speed);
  const std::array<double, 1> origin{0.0};
  ControlRun<FixedSignals> run(machine, origin);
  double sum = 0.0;
  int ticks = 0;
  const double end = ramp.duration() + settling + averaging;
  while (run.time() < end) {
    const auto motion = ramp.at(run.time());
    if (run.time() > end - averaging) {
      sum += run.plant(0).motor_force() / axis.motor.force_constant;
      ++ticks;
    }
    run.tick(std::array{sim::AxisSetPoint{motion.distance, motion.speed, motion.acceleration}}, trace);
  }
  return sum / ticks;
}

// Those of the measured steady states of the axis; without any, ten from a few thousandths of its highest speed on.
std::vector<Point> points_of(const machine::Machine& machine) {
  const auto& axis = machine.axes.front();
  std::vector<Point> points;
  for (const auto& row : machine.steady_friction_references)
    if (row.axis == axis.name) points.push_back({row.velocity, row.current});
  constexpr int count = 10;
  constexpr double lowest = 2.5e-4, highest = 0.3;  // of the highest speed
  if (points.empty())
    for (int k = 0; k < count; ++k) {
      const double speed = lowest * axis.max_velocity * std::pow(highest / lowest, k / (count - 1.0));
      points.push_back({std::strtod(fmt::format("{:.2g}", speed * 60.0).c_str(), nullptr) / 60.0, {}});
    }
  std::erase_if(points, [&](const Point& point) { return !can_drive(axis, point.speed); });
  if (points.empty())
    throw InfeasibleMotion(
        fmt::format("constant-velocity: found no speed that axis {} can drive for {:.2g} s within "
                    "its travel of {:.4g} mm; expected a longer travel or a lower speed",
                    axis.name, settling + averaging, axis.travel * 1e3));
  return points;
}

std::string per_minute(double speed) { return fmt::format("{:g}", std::round(speed * 60.0 * 1e9) * 1e-9); }

}  // namespace

sim::ExperimentResult run_constant_velocity(const ExperimentInput& input) {
  auto machine = input.machine;
  auto& axis = machine.axes.front();
  const auto effort = machine::effort_of(axis.motor);
  const auto points = points_of(machine);
  const bool measured = points.front().measured.has_value();
  sim::ExperimentResult result{
      "constant-velocity",
      "Constant velocity",
      FixedSignals::name,
      fmt::format("Which {} does axis {} take at constant speed{} (Mendricky 2006, 6.1)?", effort.name, axis.name,
                  measured ? ", and which one was measured on it" : ""),
      {},
      {},
      {}};
  sim::Chart chart{"Friction characteristic",
                   "speed, m/min",
                   effort.unit == "A" ? "current, A (amplitude)" : "voltage, V",
                   measured ? "Lines: simulated. Points: measured." : "",
                   true,
                   {}};
  for (const auto& name : input.friction) {
    axis.friction.use = name;
    sim::Series series{name, {}, {}, false};
    series.friction = name;
    double deviation = 0.0;
    for (const auto& point : points) {
      const auto speed = per_minute(point.speed);
      LogRecorder recorder(machine);
      const double found =
          steady_effort(machine, point.speed, input.keep_log ? recorder.sink() : TraceSink<FixedSignals>{});
      if (input.keep_log) input.keep_log(speed + " m/min", recorder.take());
      series.x.push_back(point.speed * 60.0);
      series.y.push_back(found);
      if (measured) deviation += std::abs(found / *point.measured - 1.0) / static_cast<double>(points.size());
      result.figures.push_back(
          sim::of_model({fmt::format("{}_{}_at_{}_m_per_min", effort.name, name, speed),
                         std::string(effort.unit),
                         fmt::format("{}, {} m/min{}", name, speed,
                                     measured ? fmt::format(" (measured {:g} {})", *point.measured, effort.unit) : ""),
                         found,
                         {}},
                        name));
    }
    chart.series.push_back(std::move(series));
    if (!measured) continue;
    result.figures.push_back(sim::of_model(
        {"mean_deviation_" + name, "%", "mean |simulated / measured - 1|, " + name, deviation * 100.0, {}}, name));
    result.findings.push_back(
        fmt::format("{}: the mean deviation from the measured {}s is {:.0f} %.", name, effort.name, deviation * 100.0));
  }
  if (measured) {
    auto& series = chart.series.emplace_back(sim::Series{"measured", {}, {}, true});
    series.role = sim::SeriesRole::measured;
    for (const auto& point : points) {
      series.x.push_back(point.speed * 60.0);
      series.y.push_back(*point.measured);
    }
  }
  result.charts.push_back(std::move(chart));
  return result;
}

}  // namespace stiction::host
