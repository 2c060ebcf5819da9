// The cams among which a next measurement is chosen: each is a motion that a drive takes, within what the record has.
#include "sim/cam/separating_cams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/laws.hpp"
#include "sim/cam/motion_file.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

CamRange returning() {
  CamRange range;
  range.cycle = turn;
  range.slave = Coordinate::linear;
  range.start = 0.01;
  range.stroke = 0.06;
  range.returns = true;
  return range;
}
CamRange indexing() {
  CamRange range;
  range.cycle = turn;
  range.slave = Coordinate::rotary;
  range.stroke = -turn / 8.0;
  range.modulo = turn / 8.0;
  return range;
}

TEST(SeparatingCams, AreThreeLawsOverTwoRisesAtThreeSpeeds) {
  std::set<std::string> laws;
  std::set<double> rises, speeds;
  for (const auto& each : separating_cams()) {
    laws.insert(each.law);
    rises.insert(each.rise_share);
    speeds.insert(each.speed_share);
    EXPECT_NE(find_law(each.law), nullptr) << each.law;
  }
  EXPECT_EQ(separating_cams().size(), 18u);
  EXPECT_EQ(laws.size(), 3u);
  EXPECT_EQ(rises.size(), 2u);
  EXPECT_EQ(speeds.size(), 3u);
  EXPECT_EQ(*speeds.rbegin(), 1.0);
}

TEST(SeparatingCams, AreMotionsWithoutAJumpThatADriveRefuses) {
  for (const auto& range : {returning(), indexing()})
    for (const auto& each : separating_cams()) {
      const auto motion = compose(separating_cam(each, range));
      for (const auto& jump : jumps_of(motion)) EXPECT_GT(jump.jump.order, 2) << each.law;
      EXPECT_EQ(problem_of(motion.cam), "");
    }
}

TEST(SeparatingCams, KeepCycleStrokeAndPlaceOfTheRecord) {
  for (const auto& each : separating_cams()) {
    const auto there = compose(separating_cam(each, returning()));
    EXPECT_DOUBLE_EQ(there.cam.cycle(), turn);
    const auto found = extremes(there.curve, 0);
    EXPECT_NEAR(found.lowest.value, 0.01, 1e-12);
    EXPECT_NEAR(found.highest.value, 0.07, 1e-12);
    EXPECT_NEAR(there.cam.position_of(there.cam.segments.size()), 0.01, 1e-12);
    EXPECT_DOUBLE_EQ(there.cam.segments[1].length, each.rise_share * 0.5 * turn);
    const auto on = separating_cam(each, indexing());
    EXPECT_DOUBLE_EQ(on.cycle(), turn);
    EXPECT_DOUBLE_EQ(on.position_of(on.segments.size()), -turn / 8.0);
    EXPECT_DOUBLE_EQ(rise_of(each, indexing()), each.rise_share * turn);
  }
}

// A record begins with a cycle: there the axis rests.
TEST(SeparatingCams, RestWhereACycleBegins) {
  for (const auto& range : {returning(), indexing()})
    for (const auto& each : separating_cams()) {
      const auto motion = compose(separating_cam(each, range));
      const double rest = motion.cam.segments.front().length;
      EXPECT_GT(rest, 0.04 * turn);
      EXPECT_DOUBLE_EQ(motion.cam.segments.back().length, rest);
      for (const double place : {0.0, 0.5 * rest, turn - 0.5 * rest}) {
        EXPECT_EQ(motion.curve.derivative(place, 1), 0.0);
        EXPECT_EQ(motion.curve.derivative(place, 2), 0.0);
      }
    }
}

// What the choice of the laws rests on: at the eleventh harmonic of the rise they differ by more than half.
TEST(SeparatingCams, HaveSpectraThatDiffer) {
  std::map<std::string, double> lines;
  for (const auto& each : separating_cams()) {
    const auto curve = unit_curve(*find_law(each.law));
    double cosine = 0.0, sine = 0.0, whole = 0.0;
    constexpr int n = 4000;
    for (int k = 0; k < n; ++k) {
      const double x = (k + 0.5) / n, a = curve.derivative(x, 2);
      cosine += a * std::cos(turn * 11.0 * x);
      sine += a * std::sin(turn * 11.0 * x);
      whole += std::abs(a);
    }
    lines[each.law] = std::hypot(cosine, sine) / whole;
  }
  for (const auto& [one, first] : lines)
    for (const auto& [other, second] : lines) {
      if (one >= other) continue;
      EXPECT_GT(std::max(first, second), 1.5 * std::min(first, second)) << one << ", " << other;
    }
}

TEST(SeparatingCams, AreTheSameFromTheirFile) {
  for (const auto& each : separating_cams()) {
    const auto cam = separating_cam(each, indexing());
    const auto again = parse_motion_file("next.toml", motion_text({cam})).front();
    ASSERT_EQ(again.segments.size(), cam.segments.size());
    for (std::size_t k = 0; k < cam.segments.size(); ++k) {
      EXPECT_EQ(again.segments[k].length, cam.segments[k].length);
      EXPECT_EQ(again.segments[k].stroke, cam.segments[k].stroke);
      EXPECT_EQ(again.segments[k].law, cam.segments[k].law);
    }
  }
}

}  // namespace
}  // namespace stiction::sim::cam
