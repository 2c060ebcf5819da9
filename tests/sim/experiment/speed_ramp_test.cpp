// The jerk-limited start: its derivatives, its ends and its two shapes.
#include "sim/experiment/speed_ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stiction::sim {
namespace {

struct Ramp {
  double speed, acceleration, jerk;
};

// The circle's feeds (0.4 m/s: trapezoidal), one with a triangular acceleration (v < a^2 / j = 0.1 m/s), and one on the
// edge between them.
const std::vector<Ramp> ramps{
    {0.4, 2.0, 40.0}, {0.8, 2.0, 40.0}, {0.053, 2.0, 40.0}, {0.1, 2.0, 40.0}, {1e-4, 5.0, 1.0}};

TEST(SpeedRamp, EachTermIsTheDerivativeOfTheOneBefore) {
  for (const auto& r : ramps) {
    const SpeedRamp ramp(r.speed, r.acceleration, r.jerk);
    const double h = 1e-5 * ramp.duration();
    for (double t = 2.0 * h; t < 1.3 * ramp.duration(); t += 0.00317 * ramp.duration()) {
      const auto before = ramp.at(t - h), now = ramp.at(t), after = ramp.at(t + h);
      // Central differences: the next derivative but one times h^2 / 6 (jerk in the distance), or a corner of the
      // acceleration (jerk * h / 4); rounding of the distance over 2 h.
      const double rounding = 1e-16 * (r.speed * ramp.duration()) / h;
      ASSERT_NEAR((after.distance - before.distance) / (2.0 * h), now.speed, r.jerk * h * h + rounding) << t;
      ASSERT_NEAR((after.speed - before.speed) / (2.0 * h), now.acceleration, 0.3 * r.jerk * h + rounding) << t;
      ASSERT_LE(std::abs(after.acceleration - before.acceleration), 2.0 * h * r.jerk * (1.0 + 1e-9)) << t;
    }
  }
}

TEST(SpeedRamp, StartsAtRestAndEndsAtSpeed) {
  for (const auto& r : ramps) {
    const SpeedRamp ramp(r.speed, r.acceleration, r.jerk);
    const auto start = ramp.at(0.0);
    EXPECT_EQ(start.distance, 0.0);
    EXPECT_EQ(start.speed, 0.0);
    EXPECT_EQ(start.acceleration, 0.0);
    const auto end = ramp.at(ramp.duration());
    EXPECT_EQ(end.speed, r.speed);
    EXPECT_EQ(end.acceleration, 0.0);
    EXPECT_NEAR(end.distance, 0.5 * r.speed * ramp.duration(), 1e-15) << "point-symmetric about its middle";
    const auto later = ramp.at(ramp.duration() + 2.0);
    EXPECT_NEAR(later.distance - end.distance, 2.0 * r.speed, 1e-15);
    EXPECT_EQ(later.speed, r.speed);
  }
}

TEST(SpeedRamp, IsContinuousAtItsJoints) {
  for (const auto& r : ramps) {
    const SpeedRamp ramp(r.speed, r.acceleration, r.jerk);
    const double peak = std::min(r.acceleration, std::sqrt(r.speed * r.jerk));
    for (const double joint : {peak / r.jerk, ramp.duration() - peak / r.jerk, ramp.duration()}) {
      const auto before = ramp.at(std::nextafter(joint, 0.0)), after = ramp.at(std::nextafter(joint, 1e9));
      EXPECT_NEAR(after.distance, before.distance, 1e-15);
      EXPECT_NEAR(after.speed, before.speed, 1e-15);
      EXPECT_NEAR(after.acceleration, before.acceleration, 1e-13);
    }
  }
}

TEST(SpeedRamp, TakesTheTimesOfTheSource) {
  // Tab 6.2: t_r = a / jerk, t_a = v / a; the start lasts t_a + t_r.
  EXPECT_NEAR(SpeedRamp(0.4, 2.0, 40.0).duration(), 0.2 + 0.05, 1e-15);
  EXPECT_NEAR(SpeedRamp(0.8, 2.0, 40.0).duration(), 0.4 + 0.05, 1e-15);
}

TEST(SpeedRamp, WithoutRoomForItsFullAccelerationIsTriangular) {
  const SpeedRamp ramp(0.053, 2.0, 40.0);
  const double peak = std::sqrt(0.053 * 40.0);
  EXPECT_LT(peak, 2.0);
  EXPECT_NEAR(ramp.duration(), 2.0 * peak / 40.0, 1e-15);
  EXPECT_NEAR(ramp.at(0.5 * ramp.duration()).acceleration, peak, 1e-12);
  EXPECT_NEAR(ramp.at(0.5 * ramp.duration()).speed, 0.5 * 0.053, 1e-15);
}

TEST(SpeedRamp, ExceedsNeitherAccelerationNorSpeed) {
  for (const auto& r : ramps) {
    const SpeedRamp ramp(r.speed, r.acceleration, r.jerk);
    double before = 0.0;
    for (double t = 0.0; t < 1.5 * ramp.duration(); t += 1e-3 * ramp.duration()) {
      const auto now = ramp.at(t);
      ASSERT_LE(now.acceleration, r.acceleration * (1.0 + 1e-12));
      ASSERT_GE(now.acceleration, 0.0);
      ASSERT_LE(now.speed, r.speed);
      ASSERT_GE(now.speed, before);
      before = now.speed;
    }
  }
}

}  // namespace
}  // namespace stiction::sim
