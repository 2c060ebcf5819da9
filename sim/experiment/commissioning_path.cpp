#include "sim/experiment/commissioning_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiction::sim {

Trajectory constant_speeds(const std::vector<double>& speeds, double cruise, double shortest,
                           const Dynamics& dynamics) {
  MoveSequence moves;
  moves.rest(0.05);
  for (const double speed : speeds)
    for (const double sign : {1.0, -1.0}) {
      moves.pass(sign * speed, std::max(cruise, shortest / speed), dynamics);
      moves.rest(0.05);
    }
  return {"constant speeds", moves.duration(), [moves](double t) { return moves.at(t); }};
}

Trajectory circle(const CircleSettings& settings, double turns) {
  const double duration = 2.0 * std::numbers::pi * settings.radius * turns / settings.feed + 0.3;
  return {"circle", duration, [path = CirclePath(settings)](double t) { return path.at(t).axes[0]; }};
}

Trajectory circle(double feed, double turns) {
  CircleSettings settings;
  settings.feed = feed;
  return circle(settings, turns);
}

Trajectory small_reversals(const std::vector<double>& amplitudes, double frequency) {
  const double w = 2.0 * std::numbers::pi * frequency;
  const double each = 2.0 / frequency;
  return {"small reversals", each * static_cast<double>(amplitudes.size()), [=](double t) {
            const auto k = std::min(static_cast<std::size_t>(t / each), amplitudes.size() - 1);
            const double a = amplitudes[k], phase = w * (t - each * static_cast<double>(k));
            return AxisSetPoint{a * (1.0 - std::cos(phase)), a * w * std::sin(phase), a * w * w * std::cos(phase)};
          }};
}

}  // namespace stiction::sim
