// A path's set-points with limited jerk.
#include "sim/experiment/smoothed_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/experiment/line_arc_path.hpp"

namespace stiction::sim {
namespace {

constexpr double speed = 8.0 / 60.0, arc_radius = 0.02, jerk = 40.0;
constexpr double window = speed * speed / arc_radius / jerk;

// Up, a quarter to the left, along -x, with Y at standstill, and a quarter back up.
LineArcPath path() {
  LineArcPath made(std::numbers::pi / 2.0, speed, 2.0, jerk);
  made.line(0.06);
  made.arc(arc_radius, std::numbers::pi / 2.0);
  made.line(0.08);
  made.arc(arc_radius, -std::numbers::pi / 2.0);
  made.line(0.05);
  return made;
}

TEST(SmoothedPath, HasVelocityAndAccelerationOfItsOwnPosition) {
  const SmoothedPath smoothed(path(), window);
  constexpr double h = 1e-4;
  for (double t = 0.003; t < path().duration(); t += 0.00173) {
    const auto before = smoothed.at(t - h), now = smoothed.at(t), after = smoothed.at(t + h);
    for (std::size_t k = 0; k < 2; ++k) {
      // Central differences: h^2/6 of the jerk, half of h of it where that steps.
      EXPECT_NEAR(now[k].velocity, (after[k].position - before[k].position) / (2.0 * h), h * h * jerk) << t;
      EXPECT_NEAR(now[k].acceleration, (after[k].velocity - before[k].velocity) / (2.0 * h), 0.51 * h * 2.0 * jerk)
          << t;
    }
  }
}

TEST(SmoothedPath, KeepsTheJerkBelowItsLimit) {
  const SmoothedPath smoothed(path(), window);
  constexpr double h = 1e-5;
  double highest = 0.0, highest_without = 0.0;
  for (double t = 0.0; t < path().duration(); t += h)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto rate = [&](const auto& of) {
        return std::abs(of.at(t + h)[k].acceleration - of.at(t)[k].acceleration) / h;
      };
      highest = std::max(highest, rate(smoothed));
      highest_without = std::max(highest_without, rate(path()));
    }
  EXPECT_LE(highest, jerk * (1.0 + 1e-6));
  EXPECT_GT(highest, 0.99 * jerk);
  EXPECT_GT(highest_without, 1e4) << "the arcs' acceleration steps";
}

TEST(SmoothedPath, StandsFromAWindowLaterToTheSameInstant) {
  const SmoothedPath smoothed(path(), window);
  const double stop = path().end_of(2), restart = path().end_of(3);
  const double place = path().at(0.5 * (stop + restart))[1].position;
  for (double t = stop + window; t <= restart; t += 1e-3) {
    EXPECT_NEAR(smoothed.at(t)[1].position, place, 1e-15);
    EXPECT_NEAR(smoothed.at(t)[1].velocity, 0.0, 1e-14);
  }
  EXPECT_LT(std::abs(smoothed.at(stop + 0.5 * window)[1].position - place), 1e-4);
  EXPECT_GT(std::abs(smoothed.at(stop + 0.9 * window)[1].velocity), 1e-6);
  EXPECT_GT(std::abs(smoothed.at(restart + 0.1 * window)[1].velocity), 1e-6);
}

TEST(SmoothedPath, BeginsAtRestAndOnALineIsTheSameHalfAWindowLate) {
  const SmoothedPath smoothed(path(), window);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(smoothed.at(0.0)[k].position, path().at(0.0)[k].position, 1e-15);
    EXPECT_NEAR(smoothed.at(0.0)[k].velocity, 0.0, 1e-15);
    EXPECT_NEAR(smoothed.at(0.0)[k].acceleration, 0.0, 1e-12);
  }
  const double middle = 0.5 * (path().end_of(2) + path().end_of(3));
  EXPECT_NEAR(smoothed.at(middle)[0].position, path().at(middle - 0.5 * window)[0].position, 1e-15);
  EXPECT_NEAR(smoothed.at(middle)[0].velocity, -speed, 1e-14);
}

TEST(SmoothedPath, WithoutAWindowIsThePathItself) {
  const SmoothedPath smoothed(path(), 0.0);
  for (const double t : {0.1, 0.5, 0.9}) {
    EXPECT_EQ(smoothed.at(t)[1].position, path().at(t)[1].position);
    EXPECT_EQ(smoothed.at(t)[1].acceleration, path().at(t)[1].acceleration);
  }
}

}  // namespace
}  // namespace stiction::sim
