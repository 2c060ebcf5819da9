// Set-points of the circle test (Mendricky 2006, 6.3): x = R cos phi, y = R sin phi from a jerk-limited start at
// phi = 0, and the lap over which it is evaluated.
#pragma once

#include <array>
#include <numbers>

#include "sim/experiment/circle_result.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/experiment/speed_ramp.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim {

struct CircleSettings {
  double feed = 0.0;     // m/s along the path
  double radius = 0.09;  // m
  Direction direction = Direction::counter_clockwise;
  double acceleration = 2.0;  // m/s^2 along the path, during the start
  double jerk = 40.0;         // m/s^3
  int laps_before = 0;        // more laps before the evaluated one, for a control that learns
};

class CirclePath {
 public:
  // The evaluated lap: one turn, begun between two quadrants after the first turn has swung in.
  static constexpr double lap_begin = 2.0 * std::numbers::pi + std::numbers::pi / 4.0;
  static constexpr double lap_end = lap_begin + 2.0 * std::numbers::pi;

  explicit CirclePath(const CircleSettings& settings)
      : radius_(settings.radius),
        turn_(settings.direction == Direction::counter_clockwise ? 1.0 : -1.0),
        ramp_(settings.feed / radius_, settings.acceleration / radius_, settings.jerk / radius_) {}

  struct Point {
    double turned;  // rad along the path since the start
    std::array<AxisSetPoint, 2> axes;
  };

  // Inline, so that a caller who asks for one axis pays for one.
  [[gnu::always_inline]] Point at(double t) const {
    const auto [phi, omega, epsilon] = ramp_.at(t);
    const auto [sine, cosine] = sine_cosine(phi);
    const double x = radius_ * cosine, minus_y = -radius_ * sine, square = omega * omega;
    return {phi,
            {{{x, minus_y * omega, minus_y * epsilon - x * square},
              {-turn_ * minus_y, turn_ * (x * omega), turn_ * (x * epsilon + minus_y * square)}}}};
  }

 private:
  double radius_;
  double turn_;     // 1 counter-clockwise, -1 clockwise
  SpeedRamp ramp_;  // of phi, rad
};

}  // namespace stiction::sim
