// The irregular path (Mendricky 2006, 6.4): straight lines and arcs with standstill of one axis, after which the axis
// restarts in the direction it stopped from or in the opposite one.
#include "host/simulate/l_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "firmware/machine/model/motor_force.hpp"
#include "host/simulate/circle.hpp"
#include "host/simulate/control_run.hpp"
#include "host/simulate/experiments.hpp"
#include "host/simulate/log_recorder.hpp"
#include "sim/experiment/line_arc_path.hpp"
#include "sim/experiment/smoothed_path.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double feed = 8.0 / 60.0;  // m/s
constexpr double mm = 1e-3;
constexpr double radius = 20 * mm;            // of all arcs
constexpr double start_acceleration = 2.0;    // m/s^2, of the start
constexpr double shortest_transition = 1e-6;  // s, far below any tick: a step is as good
constexpr double longest_transition = 0.1;    // s, from an arc to a line: a third of the shorter standstill

using Path = sim::SmoothedPath<sim::LineArcPath>;

// A-B-D-E-F-G-I-J-A, Y starts in +y, counter-clockwise. With a jerk limit the start is that of the other experiments,
// and where an arc begins or ends its acceleration v^2/r comes and goes in v^2/(r jerk).
Path l_shape(std::optional<double> jerk) {
  constexpr double pi = std::numbers::pi, heading = pi / 2.0;
  auto path = jerk ? sim::LineArcPath(heading, feed, start_acceleration, *jerk)
                   : sim::LineArcPath(heading, feed, start_acceleration);
  path.line(60 * mm);           // 1  A-B
  path.arc(radius, pi);         // 2  B-D
  path.line(100 * mm);          // 3  D-E
  path.arc(radius, pi / 2.0);   // 4  E-F
  path.line(80 * mm);           // 5  F-G: Y at standstill, after -y
  path.arc(radius, pi);         // 6  G-I: Y restarts in +y
  path.line(40 * mm);           // 7  I-J: Y at standstill, after +y
  path.arc(radius, -pi / 2.0);  // 8  J-A: Y restarts in +y
  path.line(60 * mm);           // 9  A-B again, so that the last restart dies out inside the path
  const double window = jerk ? feed * feed / radius / *jerk : 0.0;
  return {std::move(path), window < shortest_transition ? 0.0 : window};
}

// The arcs themselves have a jerk of v^3/r^2, along their tangent.
void check_jerk(double jerk) {
  const double least = std::max(feed * feed * feed / (radius * radius), feed * feed / radius / longest_transition);
  if (!(jerk >= least))
    throw InfeasibleMotion(
        fmt::format("--jerk: found {:.4g} m/s^3; expected at least {:.4g} m/s^3, which a path of "
                    "these arcs takes at {:g} m/min",
                    jerk, least, feed * 60.0));
}

// What the path asks of one axis.
struct Extent {
  double low = 0.0, high = 0.0;  // m
  double speed = 0.0, acceleration = 0.0;
  void add(const sim::AxisSetPoint& point) {
    low = std::min(low, point.position);
    high = std::max(high, point.position);
    speed = std::max(speed, std::abs(point.velocity));
    acceleration = std::max(acceleration, std::abs(point.acceleration));
  }
};

void check_limit(const machine::AxisModel& axis, const char* what, double asked, double allowed, const char* unit,
                 const char* key) {
  if (asked > allowed * (1.0 + 1e-9))
    throw InfeasibleMotion(
        fmt::format("l-shape: found a path with {} of {:.4g} {} on axis {}; expected at most "
                    "{:.4g} {}, its {}",
                    what, asked, unit, axis.name, allowed, unit, key));
}

}  // namespace

void check_l_shape(const machine::Machine& machine, std::optional<double> jerk) {
  if (machine.axes.size() != 2)
    throw InfeasibleMotion(fmt::format("l-shape: found a machine with {} axes; expected 2", machine.axes.size()));
  if (jerk) check_jerk(*jerk);
  const auto path = l_shape(jerk);
  std::array<Extent, 2> extents;
  for (double t = 0.0; t < path.duration(); t += machine.timing.slow_period) {
    const auto points = path.at(t);
    for (std::size_t k = 0; k < 2; ++k) extents[k].add(points[k]);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& axis = machine.axes[k];
    check_limit(axis, "a way", (extents[k].high - extents[k].low) * 1e3, axis.travel * 1e3, "mm", "travel");
    check_limit(axis, "a speed", extents[k].speed * 60.0, axis.max_velocity * 60.0, "m/min", "max_velocity");
    check_limit(axis, "an acceleration", extents[k].acceleration, axis.max_acceleration, "m/s^2", "max_acceleration");
  }
}

LShapeRun drive_l_shape(const machine::Machine& machine, const TraceSink<FixedSignals>& trace,
                        std::optional<double> jerk) {
  check_l_shape(machine, jerk);
  const auto path = l_shape(jerk);
  const double stop = path.path().end_of(4) + path.window(), opposite = path.path().end_of(5),
               same = path.path().end_of(7);
  const auto begin = path.at(0.0);
  const std::array<double, 2> start{begin[0].position, begin[1].position};
  ControlRun<FixedSignals> run(machine, start);
  LShapeRun r;
  int standing_ticks = 0;
  while (run.set_point_time() < path.duration()) {
    const double t = run.set_point_time();
    const double amperes = run.plant(1).motor_force() / machine.axes[1].motor.force_constant;
    run.tick(path.at(run.time()), trace);
    const double deviation = machine::to_si(run.signals(1).e);
    r.error.x.push_back(t);
    r.error.y.push_back(deviation * 1e6);
    r.current.x.push_back(t);
    r.current.y.push_back(amperes);
    // A restart is over after 10 mm of path; the standstill is settled in its second half.
    if (t >= opposite && t < opposite + 10 * mm / feed)
      r.opposite_error = std::max(r.opposite_error, std::abs(deviation));
    if (t >= same && t < same + 10 * mm / feed) r.same_error = std::max(r.same_error, std::abs(deviation));
    if (t > 0.5 * (stop + opposite) && t < opposite) {
      r.standing_current += amperes;
      ++standing_ticks;
    }
  }
  r.standing_current /= standing_ticks;
  return r;
}

sim::ExperimentResult run_l_shape(const ExperimentInput& input) {
  sim::ExperimentResult result{
      "l-shape",
      "Irregular path with standstill of one axis",
      FixedSignals::name,
      "What does friction leave at standstill, and what does a restart in the same or in the opposite direction cost? "
      "Only a model with presliding keeps the current of the last motion; a restart in the same direction then gives a "
      "small error, one in the opposite direction about the quadrant error (Mendricky 2006, 6.4).",
      {},
      {},
      {}};
  check_l_shape(input.machine, input.jerk);
  const auto path = l_shape(input.jerk);
  if (input.jerk) result.title += fmt::format(", jerk of at most {:g} m/s^3", *input.jerk);
  const auto& y = input.machine.axes[1].name;
  const auto effort = machine::effort_of(input.machine.axes[1].motor);
  sim::Chart error{"Error of " + y,
                   "time, s",
                   "error at the encoder, um",
                   fmt::format("{} is at standstill from F to G and from I to J.", y),
                   false,
                   {}};
  sim::Chart current{fmt::format("{} of {}", effort.unit == "A" ? "Current" : "Voltage", y),
                     "time, s",
                     fmt::format("motor force / force constant, {}", effort.unit),
                     "",
                     false,
                     {}};
  const auto& corners = path.path();
  const double stop = corners.end_of(4) + path.window(), opposite = corners.end_of(5),
               stop_again = corners.end_of(6) + path.window(), same = corners.end_of(7);
  for (const auto& name : input.friction) {
    auto machine = input.machine;
    for (auto& axis : machine.axes) axis.friction.use = name;
    LogRecorder recorder(machine);
    auto run =
        drive_l_shape(machine, input.keep_log ? recorder.sink<FixedSignals>() : TraceSink<FixedSignals>{}, input.jerk);
    if (input.keep_log) input.keep_log("", recorder.take());
    run.error.name = run.current.name = name;
    run.error.friction = run.current.friction = name;
    const auto add = [&](std::string figure, std::string_view unit, const std::string& text, double value) {
      sim::Figure made{std::move(figure) + "_" + name, std::string(unit), fmt::format("{}, {}", text, name), value, {}};
      made.friction = name;
      made.axis = y;
      result.figures.push_back(std::move(made));
    };
    add(fmt::format("standing_{}", effort.name), effort.unit,
        fmt::format("{} of {} at standstill from F to G (positive against the last motion)", effort.name, y),
        std::abs(run.standing_current));
    add("same_direction_error", "um", fmt::format("peak error of {}, restart in the same direction", y),
        run.same_error * 1e6);
    add("opposite_direction_error", "um", fmt::format("peak error of {}, restart in the opposite direction", y),
        run.opposite_error * 1e6);
    result.findings.push_back(fmt::format(
        "{}: {:.2f} {} {} at standstill; restart {:.1f} um in the same direction, {:.1f} um in the opposite one.", name,
        std::abs(run.standing_current), effort.unit,
        std::abs(run.standing_current) < 0.02 ? "left"
        : run.kept_current() > 0.0            ? "kept in the direction of the last motion"
                                              : "turned against the last motion",
        run.same_error * 1e6, run.opposite_error * 1e6));
    error.series.push_back(std::move(run.error));
    current.series.push_back(std::move(run.current));
  }
  error.caption = fmt::format(
      "{} is at standstill from {:.2f} s to {:.2f} s and restarts in the opposite direction; it is at standstill again "
      "from {:.2f} s to {:.2f} s and restarts in the same direction.",
      y, stop, opposite, stop_again, same);
  result.charts = {std::move(error), std::move(current)};
  return result;
}

}  // namespace stiction::host
