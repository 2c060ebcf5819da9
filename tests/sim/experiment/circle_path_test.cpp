// Set-points of the circle: on the circle, consistent in their derivatives, in both directions.
#include "sim/experiment/circle_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace stiction::sim {
namespace {

// The source's feeds, both directions.
std::vector<CircleSettings> settings() {
  std::vector<CircleSettings> all;
  for (const double metres_per_minute : {3.2, 16.0, 48.0})
    for (const auto direction : {Direction::counter_clockwise, Direction::clockwise})
      all.push_back({metres_per_minute / 60.0, 0.09, direction, 2.0, 40.0});
  return all;
}

TEST(CirclePath, StartsAtRestOnThePositiveXAxis) {
  for (const auto& s : settings()) {
    const auto point = CirclePath(s).at(0.0);
    EXPECT_EQ(point.turned, 0.0);
    EXPECT_EQ(point.axes[0].position, 0.09);
    EXPECT_EQ(point.axes[1].position, 0.0);
    for (const auto& axis : point.axes) {
      EXPECT_EQ(axis.velocity, 0.0);
      EXPECT_EQ(axis.acceleration, 0.0);
    }
  }
}

TEST(CirclePath, StaysOnItsCircleAtTheFeed) {
  for (const auto& s : settings()) {
    const CirclePath path(s);
    for (double t = 0.0; t < 5.0; t += 0.0137) {
      const auto p = path.at(t);
      ASSERT_NEAR(std::hypot(p.axes[0].position, p.axes[1].position), 0.09, 1e-16);
      ASSERT_NEAR(std::hypot(p.axes[0].velocity, p.axes[1].velocity), SpeedRamp(s.feed, 2.0, 40.0).at(t).speed, 1e-15);
      // Velocity is tangential: no radial part.
      ASSERT_NEAR(p.axes[0].position * p.axes[0].velocity + p.axes[1].position * p.axes[1].velocity, 0.0, 1e-16);
    }
  }
}

TEST(CirclePath, VelocityAndAccelerationAreTheDerivativesOfThePosition) {
  constexpr double h = 1e-5;
  for (const auto& s : settings()) {
    const CirclePath path(s);
    const double omega = s.feed / s.radius;
    for (double t = 2.0 * h; t < 3.0; t += 0.00713) {
      const auto before = path.at(t - h), now = path.at(t), after = path.at(t + h);
      for (std::size_t k = 0; k < 2; ++k) {
        // Central difference: h^2 / 6 of the third derivative (jerk + 3 w a + w^3 R), or a corner of the jerk; and the
        // rounding of positions of 0.1 m over 2 h.
        const double third = 40.0 + 3.0 * omega * 2.0 + omega * omega * omega * 0.09;
        ASSERT_NEAR((after.axes[k].position - before.axes[k].position) / (2.0 * h), now.axes[k].velocity,
                    third * h * h + 1e-11)
            << s.feed << ", " << t;
        ASSERT_NEAR((after.axes[k].velocity - before.axes[k].velocity) / (2.0 * h), now.axes[k].acceleration,
                    0.3 * third * h + 1e-10)
            << s.feed << ", " << t;
      }
    }
  }
}

TEST(CirclePath, TurnsInItsDirection) {
  for (const auto direction : {Direction::counter_clockwise, Direction::clockwise}) {
    const CirclePath path({0.2, 0.09, direction, 2.0, 40.0});
    const double sense = direction == Direction::counter_clockwise ? 1.0 : -1.0;
    double turned = 0.0, before = 0.0;
    for (double t = 0.0; t < 4.0; t += 1e-3) {
      const auto p = path.at(t);
      const double angle = std::atan2(p.axes[1].position, p.axes[0].position);
      turned += std::remainder(angle - before, 2.0 * std::numbers::pi);
      before = angle;
      ASSERT_NEAR(turned, sense * p.turned, 1e-12) << t;
      ASSERT_GE(p.turned, 0.0);
    }
    EXPECT_GT(std::abs(turned), 6.0);
  }
}

TEST(CirclePath, TheTwoDirectionsMirrorEachOtherInY) {
  const CirclePath up({0.3, 0.09, Direction::counter_clockwise, 2.0, 40.0});
  const CirclePath down({0.3, 0.09, Direction::clockwise, 2.0, 40.0});
  for (double t = 0.0; t < 3.0; t += 0.01) {
    const auto a = up.at(t), b = down.at(t);
    EXPECT_EQ(a.axes[0].position, b.axes[0].position);
    EXPECT_EQ(a.axes[0].velocity, b.axes[0].velocity);
    EXPECT_EQ(a.axes[0].acceleration, b.axes[0].acceleration);
    EXPECT_EQ(a.axes[1].position, -b.axes[1].position);
    EXPECT_EQ(a.axes[1].velocity, -b.axes[1].velocity);
    EXPECT_EQ(a.axes[1].acceleration, -b.axes[1].acceleration);
  }
}

TEST(CirclePath, ItsLapIsOneTurnAfterTheStartBetweenTwoQuadrants) {
  EXPECT_NEAR(CirclePath::lap_end - CirclePath::lap_begin, 2.0 * std::numbers::pi, 1e-15);
  EXPECT_NEAR(CirclePath::lap_begin, 2.25 * std::numbers::pi, 1e-15);
  // The fastest feed of the source has reached its speed long before.
  const SpeedRamp ramp(0.8, 2.0, 40.0);
  EXPECT_LT(ramp.at(ramp.duration()).distance / 0.09, CirclePath::lap_begin);
}

}  // namespace
}  // namespace stiction::sim
