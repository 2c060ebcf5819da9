#include "sim/experiment/move_sequence.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::sim {

AxisSetPoint MoveSequence::Move::at(double t) const {
  const double left = duration() - t;
  const auto m = ramp.at(std::min(t, left));
  if (t <= 0.5 * duration()) return {from + sign * m.distance, sign * m.speed, sign * m.acceleration};
  return {from + sign * (distance() - m.distance), sign * m.speed, -sign * m.acceleration};
}

void MoveSequence::pass(double speed, double cruise, const Dynamics& dynamics) {
  const double magnitude = std::abs(speed), sign = speed < 0.0 ? -1.0 : 1.0;
  moves_.push_back(
      {SpeedRamp(magnitude, dynamics.acceleration, dynamics.jerk), magnitude, cruise, sign, place_, time_});
  place_ += sign * moves_.back().distance();
  time_ += moves_.back().duration();
}

void MoveSequence::move(double distance, double speed, const Dynamics& dynamics) {
  const double way = std::abs(distance), reached = speed_within(way, speed, 0.0, dynamics);
  const double cruise =
      std::max(way / reached - SpeedRamp(reached, dynamics.acceleration, dynamics.jerk).duration(), 0.0);
  pass(std::copysign(reached, distance), cruise, dynamics);
}

AxisSetPoint MoveSequence::at(double t) const {
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move)
    if (t >= move->begin) return move->at(std::min(t - move->begin, move->duration()));
  return {start_};
}

double speed_within(double distance, double speed, double cruise, const Dynamics& dynamics) {
  const auto needed = [&](double v) {
    return v * (SpeedRamp(v, dynamics.acceleration, dynamics.jerk).duration() + cruise);
  };
  if (needed(speed) <= distance) return speed;
  double low = 0.0, high = speed;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (needed(middle) <= distance ? low : high) = middle;
  }
  return low;
}

}  // namespace stiction::sim
