// Records of a servo axis drawn from a seed: machine, friction law, motion, rate, encoder. The plant and its controller
// are written here and share no code with the program.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::test {

// Figures of the shipped machines (firmware/machine/shipped): mass, what a unit of effort makes, friction, speed,
// acceleration, position and velocity controller.
struct DrawnMachine {
  const char* name;
  bool voltage;
  double mass, force_constant, coulomb, viscous, static_ratio;
  double speed, acceleration;                          // m/s, m/s^2, the most that its records have
  double position_gain, velocity_gain, integral_time;  // 1/s, N s/m, s (0: none)
};
inline constexpr std::array<DrawnMachine, 4> drawn_machines{{
    {"mcfv5050ln X", false, 225.0, 94.2, 90.0, 500.0, 1.0, 1.0, 10.0, 83.3, 56500.0, 5e-3},
    {"mcfv5050ln Y", false, 520.0, 94.2, 220.0, 1250.0, 1.0, 1.0, 10.0, 83.3, 130000.0, 5e-3},
    {"emps", true, 95.1089, 35.15, 20.39, 203.5, 1.0, 0.2, 1.0, 160.2, 8557.0, 0.0},
    {"stick-slip-feed", false, 300.0, 120.0, 1000.0, 800.0, 2.0, 0.2, 4.0, 60.0, 60000.0, 20e-3},
}};

enum class DrawnFriction { coulomb_viscous, classical, linear_ramp, parabolic, lugre, maxwell_slip };

struct DrawnRecord {
  DrawnMachine machine;
  DrawnFriction friction;
  double rate = 0.0, increment = 0.0;       // Hz, m
  std::vector<double> t, x, x_set, effort;  // 16 kHz
};

namespace detail {

// Friction against the speed, with a state where the law has one.
class Law {
 public:
  Law(DrawnFriction kind, const DrawnMachine& m) : kind_(kind), m_(m) {}
  double operator()(double v, double h) {
    const double viscous = m_.viscous * v, sign = std::tanh(v / 2e-5), c = m_.coulomb;
    const double bump = 1.0 + (m_.static_ratio - 1.0) * std::exp(-std::pow(v / 1e-3, 2));
    switch (kind_) {
      case DrawnFriction::coulomb_viscous:
        return viscous + c * sign;
      case DrawnFriction::classical:
        return viscous + c * bump * sign;
      case DrawnFriction::linear_ramp:
        return viscous + c * std::clamp(v * 120.0, -1.0, 1.0);
      case DrawnFriction::parabolic:
        return std::copysign((c + 0.6 * m_.viscous) * std::cbrt(std::abs(v)), v);
      case DrawnFriction::lugre: {
        const double stiffness = c / 100e-6, g = c * bump;
        // Exact over the step for a constant speed, so that it is stable at any.
        const double steady = v == 0.0 ? z_[0] : std::copysign(g / stiffness, v);
        z_[0] = steady + (z_[0] - steady) * std::exp(-stiffness * std::abs(v) * h / g);
        return stiffness * z_[0] + viscous;
      }
      case DrawnFriction::maxwell_slip: {
        double force = viscous;
        for (std::size_t k = 0; k < z_.size(); ++k) {
          const double level = 0.25 * c, stiffness = level / (10e-6 * std::pow(3.0, static_cast<double>(k)));
          z_[k] = std::clamp(z_[k] + v * h, -level / stiffness, level / stiffness);
          force += stiffness * z_[k];
        }
        return force;
      }
    }
    return viscous;
  }

 private:
  DrawnFriction kind_;
  DrawnMachine m_;
  std::array<double, 4> z_{};
};

// Moves there and back of trapezoidal speed, or a sum of two sines.
class Path {
 public:
  template <class Random>
  Path(const DrawnMachine& m, double seconds, Random& random) {
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    sines_ = uniform(0.0, 1.0) < 0.3;
    for (int k = 0; k < 2; ++k) {
      frequency_[k] = uniform(1.0, 4.0) * (k + 1);
      const double w = 2.0 * std::numbers::pi * frequency_[k];
      amplitude_[k] = 0.4 * uniform(0.4, 1.0) * std::min(m.speed / w, m.acceleration / (w * w));
    }
    for (double t = 0.2, side = 1.0; t < seconds; side = -side) {
      Move move;
      move.begin = t;
      move.speed = side * m.speed * uniform(0.1, 0.8);
      move.acceleration = side * m.acceleration * uniform(0.3, 0.9);
      move.hold = uniform(0.05, 0.5);
      t += move.hold + 2.0 * move.speed / move.acceleration + uniform(0.02, 0.3);
      moves_.push_back(move);
      // The same way back, so that the axis stays on its travel.
      if (side < 0.0) continue;
    }
  }
  double at(double t) const {
    if (sines_) {
      double x = 0.0;
      const double ramp = std::min(1.0, t / 0.5), grown = ramp * ramp * (3.0 - 2.0 * ramp);
      for (int k = 0; k < 2; ++k) x += grown * amplitude_[k] * std::sin(2.0 * std::numbers::pi * frequency_[k] * t);
      return x;
    }
    double x = 0.0;
    for (const auto& m : moves_) {
      const double up = m.speed / m.acceleration, s = std::clamp(t - m.begin, 0.0, 2.0 * up + m.hold);
      const double rising = std::min(s, up), falling = std::max(0.0, s - up - m.hold);
      x += 0.5 * m.acceleration * (rising * rising - falling * falling) + m.speed * std::max(0.0, s - up);
    }
    return x;
  }

 private:
  struct Move {
    double begin, speed, acceleration, hold;
  };
  bool sines_ = false;
  std::array<double, 2> frequency_{}, amplitude_{};
  std::vector<Move> moves_;
};

}  // namespace detail

inline DrawnRecord draw_record(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  DrawnRecord r;
  r.machine = drawn_machines[random() % drawn_machines.size()];
  r.friction = static_cast<DrawnFriction>(random() % 6);
  r.rate = std::array{50.0, 100.0, 200.0, 500.0, 1000.0, 4000.0, 16000.0}[random() % 7];
  r.increment = std::pow(10.0, uniform(-9.0, -4.0));
  const double seconds = uniform(5.0, 10.0);
  const detail::Path path(r.machine, seconds, random);
  detail::Law friction(r.friction, r.machine);
  const auto& m = r.machine;
  const double h = 62.5e-6;
  double x = path.at(0.0), v = 0.0, integral = 0.0, force = 0.0, before = x;
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int k = 0; k < static_cast<int>(seconds / h); ++k) {
    const double t = k * h, x_set = path.at(t), v_set = (x_set - before) / h;
    before = x_set;
    const double error = m.position_gain * (x_set - x) + 0.9 * v_set - v;
    if (m.integral_time > 0.0) integral += error * h / m.integral_time;
    const double wanted = m.velocity_gain * (error + integral);
    force += (wanted - force) * h / 5e-4;  // the current loop
    // Four steps a tick, for the friction near standstill.
    for (int s = 0; s < 4; ++s) {
      v += 0.25 * h * (force - friction(v, 0.25 * h)) / m.mass;
      x += 0.25 * h * v;
    }
    r.t.push_back(t + h);
    r.x.push_back(x);
    r.x_set.push_back(x_set);
    r.effort.push_back(force / m.force_constant * (1.0 + 2e-3 * noise(random)));
  }
  return r;
}

// The record as a drive writes it, its effort late by `delay` s.
inline host::Log written(const DrawnRecord& r, double delay = 0.0) {
  host::Log log;
  log.source = r.machine.name;
  log.period = 1.0 / r.rate;
  auto& axis = log.axes.emplace_back();
  const auto stride = static_cast<std::ptrdiff_t>(std::lround(16000.0 / r.rate));
  const auto late = static_cast<std::ptrdiff_t>(std::lround(delay * 16000.0));
  const auto size = static_cast<std::ptrdiff_t>(r.t.size());
  auto& effort = r.machine.voltage ? axis.u : axis.i;
  for (std::ptrdiff_t k = 0; k < size; k += stride) {
    const auto at = static_cast<std::size_t>(k);
    log.t.push_back(static_cast<double>(log.t.size()) * log.period);
    axis.x.push_back(r.increment * std::round(r.x[at] / r.increment));
    axis.x_set.push_back(r.x_set[at]);
    effort.push_back(r.effort[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k - late, 0, size - 1))]);
  }
  return log;
}

}  // namespace stiction::test
