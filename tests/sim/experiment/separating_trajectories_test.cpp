// Each separating trajectory can be run: within its range, from rest to rest, velocity and acceleration those of the
// position.
#include "sim/experiment/separating_trajectories.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/experiment/move_sequence.hpp"

namespace stiction::test {
namespace {

// A fast linear axis, a slow screw axis, and a stroke of millimetres.
constexpr sim::MotionRange ranges[] = {
    {-0.1, 0.15, 1.2, 3.0, 60.0, 14.0}, {0.0, 0.24, 0.2, 0.7, 14.0, 0.7}, {0.002, 0.008, 0.5, 5.0, 100.0, 5.0}};

TEST(SeparatingTrajectories, stay_within_the_range_and_are_consistent) {
  for (const auto& range : ranges)
    for (const auto& kind : sim::separating_trajectories()) {
      const auto path = kind.make(range);
      const std::string what = std::string(kind.name) + ", stroke " + std::to_string(range.high - range.low);
      EXPECT_GT(path.duration, 3.0) << what;  // what a diagnosis needs
      EXPECT_LT(path.duration, 75.0) << what;
      const double slack = 1e-3 * (range.high - range.low);
      double lowest = 1e9, highest = -1e9, speed = 0.0, acceleration = 0.0, worst_v = 0.0, worst_a = 0.0;
      constexpr double step = 1e-4;
      const double jerk = range.jerk * range.highest_acceleration / range.acceleration;
      for (double t = 0.0; t < path.duration; t += 7e-4) {
        const auto point = path.at(t), before = path.at(t - step), after = path.at(t + step);
        lowest = std::min(lowest, point.position);
        highest = std::max(highest, point.position);
        speed = std::max(speed, std::abs(point.velocity));
        acceleration = std::max(acceleration, std::abs(point.acceleration));
        worst_v = std::max(worst_v, std::abs((after.position - before.position) / (2.0 * step) - point.velocity));
        worst_a = std::max(worst_a, std::abs((after.velocity - before.velocity) / (2.0 * step) - point.acceleration));
      }
      EXPECT_GE(lowest, range.low - slack) << what;
      EXPECT_LE(highest, range.high + slack) << what;
      EXPECT_LE(speed, 1.001 * range.speed) << what;
      EXPECT_LE(acceleration, 1.05 * range.highest_acceleration) << what;  // a fade adds a little of its own
      // Differences over +-0.1 ms: their error is jerk step^2 / 6 and jerk step; a small reversal begins with a jump of
      // its acceleration (8 cm/s^2 at most), which a difference meets half.
      EXPECT_LT(worst_v, jerk * step * step + 1e-5) << what;
      EXPECT_LT(worst_a, jerk * step + 0.1) << what;
      EXPECT_NEAR(path.at(0.0).position, range.low, 1e-12) << what;
      EXPECT_NEAR(path.at(path.duration).velocity, 0.0, 1e-9) << what;
    }
}

TEST(MoveSequence, covers_the_distance_it_is_told) {
  const sim::Dynamics dynamics{2.0, 40.0};
  for (const double distance : {1e-5, 1e-3, 0.3, -0.2}) {
    sim::MoveSequence moves(0.5);
    moves.move(distance, 0.4, dynamics);
    EXPECT_NEAR(moves.place(), 0.5 + distance, 1e-12);
    EXPECT_NEAR(moves.at(moves.duration()).position, 0.5 + distance, 1e-12);
  }
  EXPECT_LT(sim::speed_within(1e-3, 0.4, 0.0, dynamics), 0.4);
  EXPECT_EQ(sim::speed_within(1.0, 0.4, 0.0, dynamics), 0.4);
}

}  // namespace
}  // namespace stiction::test
