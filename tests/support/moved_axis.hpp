// The log of a rigid axis that is moved along a known way: the force is what mass, friction and weight need for it, so
// that nothing of the program's simulation is in it. Laps at several speeds, with the acceleration of a sine at each
// turn.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::test {

struct MovedAxis {
  bool rotary = false;     // then all below in rad, kg m^2, N m
  double mass = 80.0;      // kg
  double coulomb = 20.0;   // N
  double viscous = 150.0;  // N s/m
  double constant = 0.0;   // N, of the motor against what acts at all times
  double moment = 0.0;     // N m over the sine of the angle
  double per_unit = 35.0;  // N an ampere or a volt
  double increment = 1e-6;
  std::vector<double> speeds{0.0213, 0.0517, 0.1031, 0.2};  // m/s, each there and back; no whole ratios
  double stroke = 0.1;                                      // m, of a way at one speed
  double acceleration = 2.0;                                // m/s^2, the largest
  bool volts = false;                                       // the effort is u, not i
};

// At 1 kHz, in two rounds over all speeds, with what no model has in the force: a hundredth of the Coulomb friction.
inline host::Log moved(const MovedAxis& axis) {
  constexpr double period = 1e-3, pi = std::numbers::pi;
  host::Log log;
  log.source = "moved.csv";
  log.period = period;
  auto& channels = log.axes.emplace_back();
  channels.rotary = axis.rotary;
  double x = 0.0;
  const auto sample = [&](double v, double a) {
    const double t = static_cast<double>(log.t.size()) * period;
    const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
    const double force = axis.mass * a + axis.viscous * v + axis.coulomb * sign + axis.constant +
                         axis.moment * std::sin(x) + 0.01 * axis.coulomb * std::sin(2.0 * pi * 37.0 * t);
    log.t.push_back(t);
    channels.x_set.push_back(x);
    channels.x.push_back(axis.increment * std::round(x / axis.increment));
    (axis.volts ? channels.u : channels.i).push_back(force / axis.per_unit);
    x += v * period;
  };
  // From speed to speed along half a wave of the cosine.
  const auto change = [&](double from, double to) {
    const double duration = 0.5 * pi * std::abs(to - from) / axis.acceleration;
    const auto steps = static_cast<int>(duration / period);
    for (int k = 0; k < steps; ++k) {
      const double phase = pi * (k + 0.5) / steps;
      sample(from + 0.5 * (to - from) * (1.0 - std::cos(phase)), 0.5 * (to - from) * pi / duration * std::sin(phase));
    }
  };
  double speed = 0.0;
  for (int round = 0; round < 2; ++round)
    for (const double each : axis.speeds)
      for (const double way : {1.0, -1.0}) {
        change(speed, way * each);
        speed = way * each;
        for (int k = 0; k < static_cast<int>(axis.stroke / each / period); ++k) sample(speed, 0.0);
      }
  return log;
}

}  // namespace stiction::test
