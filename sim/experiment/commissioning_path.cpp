#include "sim/experiment/commissioning_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/experiment/circle_path.hpp"
#include "sim/experiment/speed_ramp.hpp"

namespace stiction::sim {
namespace {

constexpr double acceleration = 2.0, jerk = 40.0;  // m/s^2, m/s^3: those of the circle's start

// From rest to rest.
struct Move {
  SpeedRamp ramp;
  double speed, cruise, sign, from, begin;
  double duration() const { return 2.0 * ramp.duration() + cruise; }
  double distance() const { return speed * (ramp.duration() + cruise); }
  AxisSetPoint at(double t) const {
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
      const SpeedRamp ramp(speed, acceleration, jerk);
      const Move move{ramp, speed, std::max(cruise, shortest / speed), sign, 0.0, time};
      moves.push_back({move});
      if (sign < 0.0) moves.back().from = moves[moves.size() - 2].distance();
      time += move.duration() + 0.05;
    }
  return {"constant speeds", time, [moves](double t) {
            for (auto move = moves.rbegin(); move != moves.rend(); ++move)
              if (t >= move->begin) return move->at(std::min(t - move->begin, move->duration()));
            return AxisSetPoint{};
          }};
}

Trajectory circle(double feed, double turns) {
  CircleSettings settings;
  settings.feed = feed;
  const double duration = 2.0 * std::numbers::pi * settings.radius * turns / feed + 0.3;
  return {"circle", duration, [path = CirclePath(settings)](double t) { return path.at(t).axes[0]; }};
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
