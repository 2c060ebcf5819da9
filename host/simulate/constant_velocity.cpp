// Constant velocity (Mendricky 2006, 6.1): the motor current of the X axis at constant speeds against the measured one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/simulate/control_run.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/log_recorder.hpp"
#include "sim/experiment/speed_ramp.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

// Tab 5.1, X.
struct Measured {
  double speed_m_per_min, current;
};
constexpr std::array<Measured, 10> measured{{{0.02, 0.75},
                                             {0.1, 0.85},
                                             {0.5, 1.0},
                                             {1.0, 1.25},
                                             {3.2, 1.51},
                                             {5.0, 1.7},
                                             {8.0, 1.77},
                                             {10.0, 2.0},
                                             {16.0, 2.19},
                                             {24.0, 2.62}}};

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

// Mean current (A) over the last 0.1 s of a run at `speed` (m/s); the start has died out by then.
double steady_current(const machine::Machine& machine, double speed, const TraceSink<FixedSignals>& trace) {
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

}  // namespace

sim::ExperimentResult run_constant_velocity(const ExperimentInput& input) {
  sim::ExperimentResult result{"constant-velocity",
                               "Constant velocity",
                               FixedSignals::name,
                               "The current of the X axis at constant speed, with the friction parameters of Tab 6.1, "
                               "against the measured steady states of Tab 5.1 (Mendricky 2006, 6.1).",
                               {},
                               {},
                               {}};
  sim::Chart chart{"Friction characteristic",
                   "speed, m/min",
                   "current, A (amplitude)",
                   "The measured curve has a knee at low speed and rises less than linearly; no model here shows both.",
                   true,
                   {}};
  sim::Series points{"measured", {}, {}, true};
  points.role = sim::SeriesRole::measured;
  for (const auto& row : measured) {
    points.x.push_back(row.speed_m_per_min);
    points.y.push_back(row.current);
  }
  for (const auto& name : input.friction) {
    auto machine = input.machine;
    machine.axes.front().friction.use = name;
    sim::Series series{name, {}, {}, false};
    series.friction = name;
    double deviation = 0.0;
    for (const auto& row : measured) {
      if (!can_drive(machine.axes.front(), row.speed_m_per_min / 60.0)) continue;
      LogRecorder recorder(machine);
      const double current = steady_current(machine, row.speed_m_per_min / 60.0,
                                            input.keep_log ? recorder.sink() : TraceSink<FixedSignals>{});
      if (input.keep_log) input.keep_log(fmt::format("{:g} m/min", row.speed_m_per_min), recorder.take());
      series.x.push_back(row.speed_m_per_min);
      series.y.push_back(current);
      deviation += std::abs(current / row.current - 1.0) / measured.size();
      result.figures.push_back({fmt::format("current_{}_at_{:g}_m_per_min", name, row.speed_m_per_min),
                                "A",
                                fmt::format("{}, {:g} m/min (measured {:g} A)", name, row.speed_m_per_min, row.current),
                                current,
                                {}});
    }
    result.figures.push_back(
        {"mean_deviation_" + name, "%", "mean |simulated / measured - 1|, " + name, deviation * 100.0, {}});
    result.findings.push_back(
        fmt::format("{}: the mean deviation from the measured currents is {:.0f} %.", name, deviation * 100.0));
    chart.series.push_back(std::move(series));
  }
  chart.series.push_back(std::move(points));
  result.charts.push_back(std::move(chart));
  return result;
}

}  // namespace stiction::host
