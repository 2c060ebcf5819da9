#include "tests/compensation/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/simulate/log_recorder.hpp"
#include "host/simulate/quadrant_run.hpp"
#include "tests/blind/truth/trajectory.hpp"

namespace stiction::compensation {
namespace {

constexpr double radius = 0.09;       // m, of the circles that are logged
constexpr double timing_feed = 24.0;  // m/min, of the laps that the timing rule judges

sim::CircleSettings circle(double feed, double r = radius) {
  sim::CircleSettings settings;
  settings.feed = feed * metre_per_minute;
  settings.radius = r;
  return settings;
}

host::Log log_circle(const machine::Machine& machine, std::size_t axis, double feed, std::uint64_t seed) {
  const auto one = host::one_axis(machine, axis);
  host::LogRecorder recorder(one);
  host::run_quadrants(machine, axis, circle(feed), 2, recorder.sink<FixedSignals>(), {current_noise, seed});
  auto log = recorder.take();
  log.source = fmt::format("circle at {} m/min", feed);
  return log;
}

// Moves of one axis from the blind tests' pieces.
template <class EachTick>
void drive(const machine::Machine& machine, std::size_t axis, const blind::Trajectory& path, std::uint64_t seed,
           EachTick&& each_tick) {
  const auto one = host::one_axis(machine, axis);
  const std::array<double, 1> start{path.at(0.0).position};
  host::ControlRun<FixedSignals> run(one, start);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> amperes(0.0, current_noise);
  while (run.set_point_time() < path.duration()) {
    std::array<sim::AxisSetPoint, 1> set{path.at(run.time())};
    set[0].injection = amperes(random);
    run.tick(set);
    each_tick(run.set_point_time(), run);
  }
}

}  // namespace

TunedAxis tune(const Truth& truth, std::size_t axis, bool with_pulse) {
  TunedAxis tuned;
  tuned.machine = cross_table();
  tuned.axis = axis;
  truth.apply(tuned.machine.axes[axis]);
  auto& machine = tuned.machine;

  std::vector<host::Log> logs;
  for (const double feed : {3.2, 16.0, 48.0}) logs.push_back(log_circle(machine, axis, feed, 100 + logs.size()));
  std::uint64_t seed = 200;
  const auto lap = [&](const machine::Machine& with) { return log_circle(with, axis, timing_feed, seed++); };
  host::CompensationSettings settings;
  if (with_pulse) settings.pulse = circle(pulse_feed);
  tuned.tuning = host::tune_compensation(machine, axis, logs, lap, settings);
  machine = tuned.tuning.machine;
  return tuned;
}

machine::Machine with_compensation(const TunedAxis& tuned, CompensationKind kind) {
  auto machine = tuned.machine;
  machine.axes[tuned.axis].friction_compensation->use = kind;
  return machine;
}

Outcome drive_circle(const machine::Machine& machine, std::size_t axis, double feed, double r, std::uint64_t seed) {
  const bool learns = machine.axes[axis].friction_compensation->use == CompensationKind::learning;
  const int laps = learns ? learning_laps + 1 : 2;
  const auto run = host::run_quadrants(machine, axis, circle(feed, r), laps, {}, {current_noise, seed});
  return {run.peak_error.back(), run.peak_current, run.dropped};
}

Outcome drive_small_reversals(const machine::Machine& machine, std::size_t axis, double amplitude, std::uint64_t seed) {
  using blind::Piece;
  const Piece away{.kind = Piece::Kind::move, .length = 20e-3, .speed = 0.1};
  const Piece rest{.rest = 0.2};
  const Piece swings{.kind = Piece::Kind::swing, .length = amplitude, .frequency = 2.0, .cycles = 6};
  const blind::Trajectory path("small reversals", 0.0, {away, rest, swings});
  Outcome outcome;
  const double begin = path.duration() - 8.0 / 2.0;
  drive(machine, axis, path, seed, [&](double t, const auto& run) {
    outcome.current = std::max(outcome.current, std::abs(machine::to_si(run.signals(0).i)));
    if (t >= begin) outcome.error = std::max(outcome.error, std::abs(machine::to_si(run.signals(0).e)));
  });
  return outcome;
}

Standstill stand_still(const machine::Machine& machine, std::size_t axis, double seconds, std::uint64_t seed) {
  using blind::Piece;
  const Piece away{.kind = Piece::Kind::move, .length = 20e-3, .speed = 0.1};
  const Piece rest{.rest = seconds};
  const blind::Trajectory path("standstill", 0.0, {away, rest});
  Standstill result;
  const double begin = path.duration() - seconds + 1.0;  // a second to settle
  double sum = 0.0, low = 0.0, high = 0.0, first = 0.0, held = 0.0;
  int count = 0, whole = -1;
  drive(machine, axis, path, seed, [&](double t, auto& run) {
    if (t < begin) return;
    const double x = run.plant(0).encoder_position(), e = machine::to_si(run.signals(0).e_held);
    if (const int second = static_cast<int>(t - begin); second != whole) {
      if (count > 0) {
        const double mean = sum / count;
        if (whole == 0) first = mean;
        result.creep = std::max(result.creep, std::abs(mean - first));
        result.peak_to_peak = std::max(result.peak_to_peak, high - low);
      }
      whole = second;
      sum = 0.0, count = 0, low = high = x;
    }
    sum += x, ++count, low = std::min(low, x), high = std::max(high, x);
    result.changes_of_held_error += e != held;
    held = e;
  });
  return result;
}

}  // namespace stiction::compensation
