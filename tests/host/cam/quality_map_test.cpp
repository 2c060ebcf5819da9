// The map of the quality number: a pulse on a line of the map leaves that number, by the exact response of the model.
#include "host/cam/quality_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/cam/shaping/lift.hpp"
#include "tests/sim/cam/stand/study.hpp"

namespace stiction::host {
namespace {

constexpr double stand_speed = 130.0 * std::numbers::pi / 30.0;

sim::cam::ShapingTask task() {
  return shaping_task(sim::cam::indexing("parabola", 30.0, 180.0), sim::cam::study_drive(), stand_speed, 0.2, {});
}

// By the response; the area of a few half-waves is within an eighth of the mean of a sine, and what the drive leaves at
// the beginning of the dwell counts too.
double number_of(const sim::cam::ShapingTask& task, const sim::cam::Curve& lift) {
  const auto motion = compose(with_lift(task.motion.cam, lift));
  return dwell_figures(transfer_response(task.drive, motion, {.master_speed = stand_speed}), motion, task.dwell)
      .quality;
}

TEST(QualityMap, APulseOnALineLeavesTheNumberOfTheLine) {
  const auto given = task();
  const double length = 50.0 * std::numbers::pi / 180.0, untuned = number_of(given, own_rise(given, given.stroke));
  const auto lines = map_of_one_pulse(given, length, 2.0);
  ASSERT_GE(lines.size(), 4u);
  for (const LevelLine& line : lines)
    for (std::size_t k = 0; k < line.points.size(); k += 25) {
      const auto [position, amplitude] = line.points[k];
      const double found = number_of(given, with_pulse(given, {position, amplitude}, "polynomial_3_4_5", length));
      EXPECT_NEAR(found, line.level, 0.125 * line.level + 0.01 * untuned) << position << " " << amplitude;
    }
  // The published optimum is inside of the innermost line: 119.7 degrees, -1.502 degrees.
  const auto inner = std::min_element(lines.begin(), lines.end(),
                                      [](const LevelLine& a, const LevelLine& b) { return a.level < b.level; });
  const auto inside = [&](const LevelLine& line) {
    double low = 1e9, high = -1e9;
    for (const auto& [x, y] : line.points) low = std::min(low, x), high = std::max(high, x);
    const double at = 119.7 * std::numbers::pi / 180.0;
    return low < at && at < high;
  };
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                          [&](const LevelLine& line) { return line.level == inner->level && inside(line); }));
}

// A machine that does not stop, behind so many cycles that a thousandth of the first one is left.
TEST(QualityMap, OfAMachineThatRunsOnItIsTheNumberOfTheLastCycle) {
  const auto given = task();
  const auto where = *pulse_pair(given, 0.0);
  constexpr int cycles = 13;
  const auto number = [&](const sim::cam::Curve& lift) {
    auto cam = with_lift(given.motion.cam, lift);
    const auto motion = compose(cam);
    const auto states = transfer_response(given.drive, motion, {.master_speed = stand_speed, .cycles = cycles});
    return dwell_figures(states, motion, given.dwell).quality;
  };
  const double untuned = number(own_rise(given, given.stroke));
  const auto lines = map_of_two_pulses(given, where, true), at_rest = map_of_two_pulses(given, where);
  EXPECT_GT(std::fabs(lines.back().level / at_rest.back().level - 1.0), 0.1);
  for (const LevelLine& line : lines)
    for (std::size_t k = 0; k < line.points.size(); k += 9) {
      auto pair = where;
      pair.first.amplitude = line.points[k][0];
      pair.second.amplitude = line.points[k][1];
      EXPECT_NEAR(number(with_pulses(given, pair)), line.level, 0.125 * line.level + 0.01 * untuned);
    }
}

TEST(QualityMap, TwoPulsesOnALineLeaveTheNumberOfTheLine) {
  const auto given = task();
  const auto where = *pulse_pair(given, 0.0);
  const double untuned = number_of(given, own_rise(given, given.stroke));
  for (const LevelLine& line : map_of_two_pulses(given, where))
    for (std::size_t k = 0; k < line.points.size(); k += 9) {
      auto pair = where;
      pair.first.amplitude = line.points[k][0];
      pair.second.amplitude = line.points[k][1];
      EXPECT_NEAR(number_of(given, with_pulses(given, pair)), line.level, 0.125 * line.level + 0.01 * untuned);
    }
}

}  // namespace
}  // namespace stiction::host
