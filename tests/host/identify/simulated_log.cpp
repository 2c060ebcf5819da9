#include "tests/host/identify/simulated_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "firmware/machine/configuration/double_signals.hpp"
#include "firmware/machine/model/motor_force.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::test {
std::vector<Trajectory> commissioning() {
  std::vector<double> speeds;
  for (const double m_per_min : {0.05, 0.2, 0.5, 1.0, 3.2, 8.0, 16.0, 24.0}) speeds.push_back(m_per_min / 60.0);
  return {constant_speeds(speeds, 0.3, 0.4e-3), circle(16.0 / 60.0, 2.0),
          small_reversals({5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6}, 2.0)};
}

host::Log simulated(const machine::Machine& machine, const Trajectory& trajectory, double period) {
  auto one_axis = machine;
  one_axis.axes.resize(1);
  const std::array<double, 1> start{trajectory.at(0.0).position};
  host::ControlRun<machine::DoubleSignals> run(one_axis, start);
  const auto stride = static_cast<int>(std::lround(period / machine.timing.fast_period));
  host::Log log;
  log.source = trajectory.name;
  log.period = period;
  auto& axis = log.axes.emplace_back();
  axis.axis = machine.axes.front().name;
  for (int tick = 0; run.time() < trajectory.duration; ++tick) {
    const auto set = trajectory.at(run.time());
    if (tick % stride == 0) {
      log.t.push_back(run.time());
      axis.x_set.push_back(set.position);
      axis.x.push_back(run.plant(0).encoder_position());
      axis.i.push_back(run.plant(0).motor_force() / machine::acting_force_constant(machine.axes.front().motor));
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
