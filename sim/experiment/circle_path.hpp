// Set-points of the circle test (Mendricky 2006, 6.3): x = R cos phi, y = R sin phi from a jerk-limited start at
// phi = 0, and the lap over which it is evaluated.
#pragma once

#include <array>
#include <numbers>

#include "sim/experiment/circle_result.hpp"
#include "sim/experiment/set_point.hpp"
#include "sim/experiment/speed_ramp.hpp"
#include "sim/sine_cosine.hpp"

namespace stiction::sim {

struct CircleSettings {
  double feed = 0.0;     // m/s along the path
  double radius = 0.09;  // m
  Direction direction = Direction::counter_clockwise;
  double acceleration = 2.0;  // m/s^2 along the path, during the start
  double jerk = 40.0;         // m/s^3
};

class CirclePath {
 public:
  // The evaluated lap: one turn, begun between two quadrants after the first turn has swung in.
  static constexpr double lap_begin = 2.0 * std::numbers::pi + std::numbers::pi / 4.0;
  static constexpr double lap_end = lap_begin + 2.0 * std::numbers::pi;

  explicit CirclePath(const CircleSettings& settings)
      : radius_(settings.radius),
        curvature_(1.0 / settings.radius),
        signed_radius_(settings.direction == Direction::counter_clockwise ? radius_ : -radius_),
        signed_curvature_(1.0 / signed_radius_),
        ramp_(settings.feed, settings.acceleration, settings.jerk) {}

  struct Point {
    double turned;  // rad along the path since the start
    std::array<AxisSetPoint, 2> axes;
  };

  // Inline, so that a caller who asks for one axis pays for one.
  [[gnu::always_inline]] Point at(double t) const {
    const auto motion = ramp_.at(t);
    const double phi = motion.distance * curvature_;
    const double omega = motion.speed * signed_curvature_;
    const double epsilon = motion.acceleration * signed_curvature_;
    const auto [sine, cosine] = sine_cosine(phi);
    const double x = radius_ * cosine;
    const double y = signed_radius_ * sine;
    const double v_x = -y * omega;
    const double v_y = x * omega;
    return {phi, {{{x, v_x, -y * epsilon - v_y * omega}, {y, v_y, x * epsilon + v_x * omega}}}};
  }

 private:
  double radius_;
  double curvature_;         // 1/m
  double signed_radius_;     // m, positive counter-clockwise
  double signed_curvature_;  // 1/m
  SpeedRamp ramp_;
};

}  // namespace stiction::sim
