#include "tests/host/diagnose/synthetic_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "sim/plant/friction/lugre.hpp"
#include "sim/plant/friction/parameters.hpp"

namespace stiction::test {
namespace {

constexpr double period = 1e-3, fine = 1e-4, duration = 25.0;  // s
constexpr double force_constant = 94.0;                        // N/A

// Set speed: a sum of smooth pieces, differentiated and integrated exactly enough by the fine step.
double speed_at(int trajectory, double t) {
  constexpr double pi = std::numbers::pi;
  if (trajectory == 0) {
    // Passes of 1 s at changing speeds, each from rest to rest with rounded edges.
    constexpr double speeds[] = {0.02, 0.2, 0.05, 0.1, 0.3, 0.01, 0.15, 0.005, 0.25};
    const int pass = static_cast<int>(t);
    const double s = t - pass, edge = 0.15;
    const double up = std::clamp(s / edge, 0.0, 1.0), down = std::clamp((1.0 - s) / edge, 0.0, 1.0);
    const auto smooth = [](double u) { return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u); };
    return (pass % 2 == 0 ? 1.0 : -1.0) * speeds[(pass / 2) % 9] * smooth(up) * smooth(down);
  }
  if (trajectory == 1)
    return 0.12 * std::sin(2.0 * pi * 0.31 * t) + 0.07 * std::sin(2.0 * pi * 0.83 * t + 1.0) * std::min(t, 1.0);
  return 0.16 * std::sin(2.0 * pi * 0.23 * t) * (0.6 + 0.4 * std::sin(2.0 * pi * 0.071 * t)) +
         0.02 * std::sin(2.0 * pi * 1.9 * t);
}

// Position of the other axis and its acceleration.
struct Other {
  double x, a;
};
Other other_at(double t) {
  constexpr double pi = std::numbers::pi, first = 2.0 * pi * 0.53, second = 2.0 * pi * 2.1;
  return {0.06 * std::sin(first * t + 0.4) + 0.006 * std::sin(second * t),
          -0.06 * first * first * std::sin(first * t + 0.4) - 0.006 * second * second * std::sin(second * t)};
}

// Current for a force (N).
double current_of(const Hidden& hidden, double force) {
  if (hidden.saturation_current <= 0.0) return force / hidden.force_constant;
  return hidden.saturation_current * std::atanh(force / (hidden.force_constant * hidden.saturation_current));
}

}  // namespace

machine::Machine bench_machine() {
  machine::Machine machine;
  machine.name = machine.id = "bench";
  machine::AxisModel axis;
  axis.name = "X";
  axis.mass = 225.0;
  axis.travel = 1.0;
  axis.max_velocity = 1.0;
  axis.max_acceleration = 20.0;
  axis.motor.model = machine::MotorModel::dc;
  axis.motor.force_constant = force_constant;
  axis.inverter.current_limit = 70.0;
  axis.friction.use = "lugre";
  sim::set_parameters<sim::LuGre<>>(axis.friction, {90.0, 1.0, 500.0, 1e-3, 8e5, 0.0});
  machine.axes = {axis};
  return machine;
}

host::Log synthetic_log(int trajectory, const Hidden& hidden, double noise_rms, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> force, position;
  double x = 0.0, z = 0.0, other_z = 0.0, measured = 0.0, followed = 0.0;
  const auto steps = static_cast<int>(duration / fine);
  for (int k = 0; k < steps; ++k) {
    const double t = k * fine, v = speed_at(trajectory, t);
    const double a =
        (speed_at(trajectory, t + 0.5 * fine) - speed_at(trajectory, std::max(t - 0.5 * fine, 0.0))) / fine;
    const double moved = k == 0 ? 0.0 : 0.5 * (v + speed_at(trajectory, t - fine)) * fine;
    x += moved;
    const double sign = moved < 0.0 ? -1.0 : 1.0;
    z = sign + (z - sign) * std::exp(-std::abs(moved) / hidden.contact_length);
    other_z = sign + (other_z - sign) * std::exp(-std::abs(moved) / hidden.other_length);
    measured = std::clamp(measured, x - 0.5 * hidden.lost_motion, x + 0.5 * hidden.lost_motion);
    const Point point{t, x, v, a, z};
    followed = hidden.friction_lag > 0.0 ? v + (followed - v) * std::exp(-fine / hidden.friction_lag) : v;
    const double contact = hidden.coulomb * (z + hidden.other_share * (other_z - z));
    const double needed = hidden.mass * a + contact + hidden.viscous * followed - hidden.other_mass * other_at(t).a +
                          (hidden.force ? hidden.force(point) : 0.0);
    force.push_back(hidden.constant_ripple ? needed / (1.0 + hidden.constant_ripple(x)) : needed);
    position.push_back(measured + (hidden.reading_error ? hidden.reading_error(measured) : 0.0));
  }
  host::Log log;
  log.source = "trajectory " + std::to_string(trajectory);
  log.period = period;
  log.axes.resize(2);
  log.axes[1].axis = "Y";
  auto& axis = log.axes.front();
  axis.axis = "X";
  const auto ratio = static_cast<int>(std::lround(period / fine));
  const auto late = static_cast<int>(std::lround(hidden.delay / fine));
  double noise = noise_rms * normal(random);
  for (int k = 0; k < steps; k += ratio) {
    const double keep = 0.95;  // correlation from sample to sample: 20 ms
    noise = keep * noise + noise_rms * std::sqrt(1.0 - keep * keep) * normal(random);
    log.t.push_back(k * fine);
    axis.x.push_back(1e-9 * std::round(1e9 * position[static_cast<std::size_t>(k)]));
    log.axes[1].x.push_back(1e-9 * std::round(1e9 * other_at(k * fine).x));
    axis.i.push_back(current_of(hidden, force[static_cast<std::size_t>(std::clamp(k - late, 0, steps - 1))] + noise));
  }
  return log;
}

}  // namespace stiction::test
