// Constant velocity (Mendricky 2006, 6.1): current or voltage at constant speeds, compared with the measured one. Of an
// axis with a weight: less what holds it, so that friction is left.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/log/shown_units.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/log_recorder.hpp"
#include "host/simulate/starts.hpp"
#include "sim/experiment/speed_ramp.hpp"
#include "sim/plant/gravity.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// One speed, and what drove the real axis at it.
struct Point {
  double speed;                    // m/s
  std::optional<double> measured;  // A or V
};

constexpr double settling = 0.4, averaging = 0.1;  // s
constexpr double steady = 0.05;                    // deviation of the mean speed that is none, of the speed
constexpr double longest = 20.0;                   // s, in which an axis of a soft controller comes to its speed

sim::SpeedRamp start_of(const machine::AxisModel& axis, double speed) {
  const auto start = start_on(axis);
  return {speed, start.acceleration, start.jerk};
}

bool can_drive(const machine::AxisModel& axis, double speed) {
  const auto start = start_of(axis, speed);
  if (speed > axis.max_velocity || speed >= highest_followed_speed(axis)) return false;
  return axis.modulo || start.at(start.duration() + settling + averaging).distance <= axis.travel;
}

// Mean motor force less the weight, over the force constant (A, or V of a force source), over the last 0.1 s of a run
// at `speed` (m/s); the start has died out by then, and the axis is at its speed, or at the end of its way.
template <class S>
double steady_effort(const machine::Machine& machine, double speed, const TraceSink<S>& trace) {
  const auto& axis = machine.axes.front();
  const auto ramp = start_of(axis, speed);
  const std::array<double, 1> origin{0.0};
  ControlRun<S> run(machine, origin);
  double sum = 0.0, begin = 0.0;
  int ticks = 0;
  double end = ramp.duration() + settling + averaging;
  while (run.time() < end) {
    const auto motion = ramp.at(run.time());
    auto& plant = run.plant(0);
    if (run.time() > end - averaging) {
      if (ticks == 0) begin = plant.position();
      const double weight = axis.gravity ? sim::gravity_force(axis, plant.position()) : 0.0;
      sum += (plant.motor_force() - weight) / axis.motor.force_constant;
      ++ticks;
    }
    run.tick(std::array{sim::AxisSetPoint{motion.distance, motion.speed, motion.acceleration}}, trace);
    if (run.time() < end) continue;
    const bool room = axis.modulo || motion.distance + averaging * speed <= axis.travel;
    const double mean = (run.plant(0).position() - begin) / (ticks * machine.timing.fast_period);
    if (std::abs(mean / speed - 1.0) < steady || !room || end > longest) break;
    end += averaging;
    sum = 0.0;
    ticks = 0;
  }
  return sum / ticks;
}

// Those of the measured steady states of the axis; without any, ten from a few thousandths of its highest speed on, of
// two digits in the unit that they are shown in.
std::vector<Point> points_of(const machine::Machine& machine, const ShownUnits& own) {
  const auto& axis = machine.axes.front();
  std::vector<Point> points;
  for (const auto& row : machine.steady_friction_references)
    if (row.axis == axis.name) points.push_back({row.velocity, row.current});
  constexpr int count = 10;
  constexpr double lowest = 2.5e-4, highest = 0.3;  // of the highest speed
  if (points.empty())
    for (int k = 0; k < count; ++k) {
      const double speed = lowest * axis.max_velocity * std::pow(highest / lowest, k / (count - 1.0));
      points.push_back({std::strtod(fmt::format("{:.2g}", own.feed(speed)).c_str(), nullptr) / own.feed.factor, {}});
    }
  std::erase_if(points, [&](const Point& point) { return !can_drive(axis, point.speed); });
  if (points.empty())
    throw InfeasibleMotion(
        fmt::format("constant-velocity: found no speed that axis {} can drive for {:.2g} s within "
                    "its travel of {:.4g} {}; expected a longer travel or a lower speed",
                    axis.name, settling + averaging, own.position(axis.travel), own.position.unit));
  return points;
}

// "3.2" of a speed (m/s), in the unit of a feed.
std::string speed_text(double speed, const ShownUnits& own) {
  return fmt::format("{:g}", std::round(own.feed(speed) * 1e9) * 1e-9);
}

template <class S>
sim::ExperimentResult constant_velocity_with(const ExperimentInput& input) {
  auto machine = input.machine;
  auto& axis = machine.axes.front();
  const ShownUnits own(axis.coordinate);
  const std::string unit = own.feed.unit;
  const auto effort = machine::effort_of(axis.motor);
  const auto points = points_of(machine, own);
  const bool measured = points.front().measured.has_value();
  sim::ExperimentResult result{
      "constant-velocity",
      "Constant velocity",
      S::name,
      fmt::format("Which {} does axis {} take at constant speed{} (Mendricky 2006, 6.1)?", effort.name, axis.name,
                  measured ? ", and which one was measured on it" : ""),
      {},
      {},
      {}};
  sim::Chart chart{"Friction characteristic",
                   "speed, " + unit,
                   effort.unit == "A" ? "current, A (amplitude)" : "voltage, V",
                   measured       ? "Lines: simulated. Points: measured."
                   : axis.gravity ? "Without the part that holds the weight."
                                  : "",
                   true,
                   {}};
  for (const auto& name : input.friction) {
    axis.friction.use = name;
    sim::Series series{name, {}, {}, false};
    series.friction = name;
    double deviation = 0.0;
    for (const auto& point : points) {
      const auto speed = speed_text(point.speed, own);
      LogRecorder recorder(machine);
      const double found = steady_effort<S>(machine, point.speed, input.keep_log ? recorder.sink<S>() : TraceSink<S>{});
      if (input.keep_log) input.keep_log(speed + " " + unit, recorder.take());
      series.x.push_back(own.feed(point.speed));
      series.y.push_back(found);
      if (measured) deviation += std::abs(found / *point.measured - 1.0) / static_cast<double>(points.size());
      result.figures.push_back(
          sim::of_model({fmt::format("{}_{}_at_{}_{}", effort.name, name, speed, own.feed.key),
                         std::string(effort.unit),
                         fmt::format("{}, {} {}{}", name, speed, unit,
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
      series.x.push_back(own.feed(point.speed));
      series.y.push_back(*point.measured);
    }
  }
  result.charts.push_back(std::move(chart));
  return result;
}

}  // namespace

sim::ExperimentResult run_constant_velocity(const ExperimentInput& input) {
  const bool firmware = input.machine.axes.front().cascaded() && input.machine.fits_formats();
  return firmware ? constant_velocity_with<FixedSignals>(input) : constant_velocity_with<machine::DoubleSignals>(input);
}

}  // namespace stiction::host
