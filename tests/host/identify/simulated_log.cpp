#include "tests/host/identify/simulated_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "host/simulate/control_run.hpp"
#include "sim/control/double_signals.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/speed_ramp.hpp"

namespace stiction::test {
namespace {

constexpr double acceleration = 2.0, jerk = 40.0;  // m/s^2, m/s^3: those of the circle's start

// From rest to rest.
struct Move {
  sim::SpeedRamp ramp;
  double speed, cruise, sign, from, begin;
  double duration() const { return 2.0 * ramp.duration() + cruise; }
  double distance() const { return speed * (ramp.duration() + cruise); }
  sim::AxisSetPoint at(double t) const {
    const double left = duration() - t;
    const auto m = ramp.at(std::min(t, left));
    if (t <= 0.5 * duration()) return {from + sign * m.distance, sign * m.speed, sign * m.acceleration};
    return {from + sign * (distance() - m.distance), sign * m.speed, -sign * m.acceleration};
  }
};

}  // namespace

Trajectory constant_speeds(const std::vector<double>& speeds, double cruise, double shortest) {
  std::vector<Move> moves;
  double time = 0.05;
  for (const double speed : speeds)
    for (const double sign : {1.0, -1.0}) {
      const sim::SpeedRamp ramp(speed, acceleration, jerk);
      const Move move{ramp, speed, std::max(cruise, shortest / speed), sign, 0.0, time};
      moves.push_back({move});
      if (sign < 0.0) moves.back().from = moves[moves.size() - 2].distance();
      time += move.duration() + 0.05;
    }
  return {"constant speeds", time, [moves](double t) {
            for (auto move = moves.rbegin(); move != moves.rend(); ++move)
              if (t >= move->begin) return move->at(std::min(t - move->begin, move->duration()));
            return sim::AxisSetPoint{};
          }};
}

Trajectory circle(double feed, double turns) {
  sim::CircleSettings settings;
  settings.feed = feed;
  const double duration = 2.0 * std::numbers::pi * settings.radius * turns / feed + 0.3;
  return {"circle", duration, [path = sim::CirclePath(settings)](double t) { return path.at(t).axes[0]; }};
}

Trajectory small_reversals(const std::vector<double>& amplitudes, double frequency) {
  const double w = 2.0 * std::numbers::pi * frequency;
  const double each = 2.0 / frequency;
  return {"small reversals", each * static_cast<double>(amplitudes.size()), [=](double t) {
            const auto k = std::min(static_cast<std::size_t>(t / each), amplitudes.size() - 1);
            const double a = amplitudes[k], phase = w * (t - each * static_cast<double>(k));
            return sim::AxisSetPoint{a * (1.0 - std::cos(phase)), a * w * std::sin(phase), a * w * w * std::cos(phase)};
          }};
}

std::vector<Trajectory> commissioning() {
  std::vector<double> speeds;
  for (const double m_per_min : {0.05, 0.2, 0.5, 1.0, 3.2, 8.0, 16.0, 24.0}) speeds.push_back(m_per_min / 60.0);
  return {constant_speeds(speeds, 0.3, 0.4e-3), circle(16.0 / 60.0, 2.0),
          small_reversals({5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6}, 2.0)};
}

host::Log simulated(const sim::Machine& machine, const Trajectory& trajectory, double period) {
  auto one_axis = machine;
  one_axis.axes.resize(1);
  const std::array<double, 1> start{trajectory.at(0.0).position};
  host::ControlRun<sim::DoubleSignals> run(one_axis, start);
  const auto stride = static_cast<int>(std::lround(period / machine.timing.fast_period));
  host::Log log{trajectory.name, {}, {}, period, {{}}, {}};
  auto& axis = log.axes.front();
  axis.axis = machine.axes.front().name;
  for (int tick = 0; run.time() < trajectory.duration; ++tick) {
    const auto set = trajectory.at(run.time());
    if (tick % stride == 0) {
      log.t.push_back(run.time());
      axis.x_set.push_back(set.position);
      axis.x.push_back(run.plant(0).encoder_position());
      axis.i.push_back(run.plant(0).motor_force() / machine.axes.front().motor.force_constant);
    }
    run.tick(std::array{set});
  }
  return log;
}

host::Log with_noise(const host::Log& log, const Noise& noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  auto noisy = log;
  for (auto& axis : noisy.axes) {
    double largest = 0.0;
    for (const double i : axis.i) largest = std::max(largest, std::abs(i));
    for (double& x : axis.x) {
      x += noise.position * normal(random);
      if (noise.position > 0.0) x = noise.position * std::round(x / noise.position);
    }
    for (double& i : axis.i) i += noise.current * largest * normal(random);
  }
  return noisy;
}

}  // namespace stiction::test
