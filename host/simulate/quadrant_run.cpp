#include "host/simulate/quadrant_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "host/simulate/circle.hpp"

namespace stiction::host {

machine::Machine one_axis(const machine::Machine& machine, std::size_t axis) {
  machine::Machine one = machine;
  one.axes = {machine.axes.at(axis)};
  return one;
}

QuadrantRun run_quadrants(const machine::Machine& machine, std::size_t axis, const sim::CircleSettings& settings,
                          int laps, const TraceSink<FixedSignals>& trace, const CurrentNoise& noise) {
  check_circle(machine.axes.at(axis), settings);
  const machine::Machine one = one_axis(machine, axis);
  const std::size_t coordinate = axis % 2;  // the first and every second axis along x of the circle
  const sim::CirclePath path(settings);
  const std::array<double, 1> start{path.at(0.0).axes[coordinate].position};
  ControlRun<FixedSignals> run(one, start);
  constexpr double turn = 2.0 * std::numbers::pi, first = sim::CirclePath::lap_begin - turn;
  std::mt19937_64 random(noise.seed);
  std::normal_distribution<double> amperes(0.0, noise.rms > 0.0 ? noise.rms : 1.0);
  QuadrantRun result;
  result.peak_error.assign(static_cast<std::size_t>(laps), 0.0);
  for (;;) {
    const double turned = path.at(std::max(0.0, run.set_point_time())).turned - first;
    if (turned >= turn * laps) break;
    std::array<sim::AxisSetPoint, 1> set{path.at(run.time()).axes[coordinate]};
    if (noise.rms > 0.0) set[0].injection = amperes(random);
    run.tick(set, trace);
    const auto& s = run.signals(0);
    result.peak_current = std::max(result.peak_current, std::abs(machine::to_si(s.i)));
    if (turned < 0.0) continue;
    auto& peak = result.peak_error[static_cast<std::size_t>(turned / turn)];
    peak = std::max(peak, std::abs(machine::to_si(s.e)));
  }
  if (const auto* compensation = run.compensation(0)) {
    result.dropped = compensation->dropped();
    for (const auto current : compensation->learned()[1]) result.learned_forward.push_back(machine::to_si(current));
    for (const auto current : compensation->learned()[0]) result.learned_backward.push_back(machine::to_si(current));
  }
  return result;
}

}  // namespace stiction::host
