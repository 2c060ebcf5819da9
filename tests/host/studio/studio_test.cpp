// The studio's steps of editing: what a dragged level takes along, what is refused, and what undo brings back.
#include "host/studio/studio.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/simulate/cam_run.hpp"
#include "host/studio/level.hpp"
#include "host/studio/read_back.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/segment_table.hpp"
#include "sim/machine_file.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double rounding = 1e-12;  // of angles of a few rad

using sim::cam::Cam;
using sim::cam::CamError;

// A rise to 40 degrees, a rest, the return, a rest.
Cam out_and_back() {
  Cam cam;
  cam.name = "there";
  cam.segments = {{.length = 100 * degree, .stroke = 40 * degree, .law = "modified_sine"},
                  {.length = 60 * degree},
                  {.length = 120 * degree, .stroke = -40 * degree, .law = "sloping_sine"},
                  {.length = 80 * degree}};
  return cam;
}

Cam indexing() {
  Cam cam;
  cam.name = "dial";
  cam.modulo = 45 * degree;
  cam.segments = {{.length = 140 * degree, .stroke = 45 * degree, .law = "modified_sine"}, {.length = 220 * degree}};
  return cam;
}

TEST(StudioLevel, KeepsTheRestBehindItAndLetsTheNextMovementTakeTheDifference) {
  for (const std::size_t at : {0U, 1U}) {  // the begin and the end of the rest are one level
    const Cam moved = with_level(out_and_back(), at, 50 * degree);
    EXPECT_NEAR(moved.segments[0].stroke, 50 * degree, rounding);
    EXPECT_EQ(moved.segments[1].stroke, 0.0);
    EXPECT_NEAR(moved.segments[2].stroke, -50 * degree, rounding);
    EXPECT_EQ(moved.start, 0.0);
  }
}

TEST(StudioLevel, OfTheLastRestMovesTheModuloOfAnEndlessCam) {
  const Cam moved = with_level(indexing(), 0, 60 * degree);
  EXPECT_NEAR(*moved.modulo, 60 * degree, rounding);
  EXPECT_NEAR(moved.segments[0].stroke, 60 * degree, rounding);
  EXPECT_EQ(problem_of(moved), "");
}

TEST(StudioLevel, AtWhichAPeriodicCamClosesIsRefused) {
  EXPECT_THROW(with_level(out_and_back(), 3, 10 * degree), CamError);
  EXPECT_THROW(with_level(out_and_back(), 4, 10 * degree), CamError);
}

TEST(StudioLevel, BeforeTheFirstMovementIsThatBehindTheLastOne) {
  Cam cam = out_and_back();
  std::rotate(cam.segments.begin(), cam.segments.begin() + 3, cam.segments.end());  // begins with a rest
  const Cam moved = with_level(cam, 0, 5 * degree);
  EXPECT_NEAR(moved.start, 5 * degree, rounding);
  EXPECT_NEAR(moved.segments[1].stroke, 35 * degree, rounding);
  EXPECT_NEAR(moved.segments[3].stroke, -35 * degree, rounding);
  EXPECT_EQ(problem_of(moved), "");
}

TEST(StudioLevel, OfAMotionThatRestsLiftsItAsAWhole) {
  Cam cam = out_and_back();
  cam.segments = {{.length = 360 * degree}};
  EXPECT_NEAR(with_level(cam, 0, 7 * degree).start, 7 * degree, rounding);
}

TEST(StudioCycle, KeepsTheShareOfEverySegmentAndTrack) {
  Cam cam = indexing();
  cam.tracks.push_back({.name = "pin", .windows = {{10 * degree, 20 * degree}}, .hysteresis = 2 * degree});
  const Cam half = with_cycle(cam, 180 * degree);
  EXPECT_NEAR(half.segments[0].length, 70 * degree, rounding);
  EXPECT_NEAR(half.segments[1].length, 110 * degree, rounding);
  EXPECT_NEAR(half.tracks[0].windows[0].last, 10 * degree, rounding);
  EXPECT_NEAR(half.tracks[0].hysteresis, 1 * degree, rounding);
  EXPECT_THROW(with_cycle(cam, 0.0), CamError);
}

class StudioOf : public testing::Test {
 protected:
  StudioOf() { studio.load_motion("there.toml", sim::cam::motion_text({out_and_back()})); }

  Studio studio;
};

TEST_F(StudioOf, AMotionWritesItAsTheWriterDoes) {
  EXPECT_EQ(studio.motion_text(), sim::cam::motion_text({out_and_back()}));
}

TEST_F(StudioOf, AMotionUndoesAndRedoesEachStep) {
  const auto before = studio.motion_text();
  studio.edit({.verb = "law", .at = 0, .key = "3-4-5"});
  const auto behind = studio.motion_text();
  studio.edit({.verb = "value", .at = 0, .key = "lambda", .x = 0.4});
  EXPECT_TRUE(studio.undo());
  EXPECT_EQ(studio.motion_text(), behind);
  EXPECT_TRUE(studio.undo());
  EXPECT_EQ(studio.motion_text(), before);
  EXPECT_TRUE(studio.redo());
  EXPECT_EQ(studio.motion_text(), behind);
  EXPECT_TRUE(studio.redo());
  EXPECT_FALSE(studio.redo());
}

TEST_F(StudioOf, ADragIsOneStepToUndo) {
  const auto before = studio.motion_text();
  for (int k = 1; k < 20; ++k)
    studio.edit({.verb = "drag", .at = 0, .x = (100 + k) * degree, .y = (40 + k) * degree, .goes_on = k > 1});
  EXPECT_NEAR(studio.cam().segments[0].length, 119 * degree, rounding);
  EXPECT_TRUE(studio.undo());
  EXPECT_EQ(studio.motion_text(), before);
}

TEST_F(StudioOf, AMotionStaysAsItWasBehindARefusedStep) {
  const auto before = studio.motion_text();
  const auto state = studio.state_json(1.0);
  EXPECT_THROW(studio.edit({.verb = "law", .at = 0, .key = "no such law"}), CamError);
  EXPECT_THROW(studio.edit({.verb = "drag", .at = 0, .x = 170 * degree, .y = 0.0}), CamError);
  EXPECT_THROW(studio.edit({.verb = "value", .at = 0, .key = "lambda", .x = 7.0}), std::runtime_error);
  EXPECT_THROW(studio.edit({.verb = "remove", .at = 9}), CamError);
  EXPECT_THROW(studio.edit({.verb = "fly"}), CamError);
  EXPECT_THROW(studio.load_motion("newer.toml", "schema = \"stiction.cam/2\"\n"), machine::MachineFileError);
  EXPECT_EQ(studio.motion_text(), before);
  EXPECT_EQ(studio.state_json(1.0), state);
}

TEST(StudioOfNothing, BeginsWithARestThatIsAMotionFile) {
  const Studio studio;
  const auto cams = sim::cam::parse_motion_file("empty.toml", studio.motion_text());
  ASSERT_EQ(cams.size(), 1U);
  EXPECT_NEAR(cams[0].cycle(), 360 * degree, rounding);
  EXPECT_THROW(studio.follow(1.0, 1), CamError);
}

TEST(StudioOfNothing, TakesASlopingSineAndItsHarmonicsFromTheLaw) {
  // y'' of the sloping sine over the whole cycle is one sine of 2 pi.
  Studio studio;
  studio.load_motion("one.toml",
                     "schema = \"stiction.cam/1\"\n[cam.one]\ncycle = \"360 deg\"\nslave = \"rotary\"\nmodulo = \"360 "
                     "deg\"\n[[cam.one.segment]]\nend = \"360 deg\"\nstroke = \"360 deg\"\nlaw = \"sloping sine\"\n");
  const auto amplitudes = studio.harmonics(5);
  EXPECT_NEAR(amplitudes[0], 1.0, 1e-12);  // 2 pi h / L^2 with h = L = 2 pi
  for (std::size_t k = 1; k < amplitudes.size(); ++k) EXPECT_NEAR(amplitudes[k], 0.0, 1e-12);
}

sim::cam::Motion smooth_motion() {
  return compose(sim::cam::read_motion_file(STICTION_SOURCE_DIR "/tests/host/studio/smooth.toml").front());
}

// Largest difference of the positions of two motions over a cycle.
double difference(const sim::cam::Motion& a, const sim::cam::Motion& b) {
  double largest = 0.0;
  for (int k = 0; k < 3600; ++k) {
    const double x = a.curve.length() * k / 3600.0;
    largest = std::max(largest, std::fabs(a.curve(x) - b.curve(x)));
  }
  return largest;
}

TEST(ReadBack, TheTableOfTheDriveIsTheMotionWithinItsProvenBound) {
  const auto motion = smooth_motion();
  const auto table = table_within(motion, sim::cam::table_tolerance(motion));
  const auto read = compose(cam_of_table(table.bytes, "read"));
  EXPECT_NEAR(read.cam.cycle(), motion.cam.cycle(), rounding);
  EXPECT_NEAR(*read.cam.modulo, 30 * degree, 1e-9);
  // The drive's integers are within the bound of the motion, and the read motion within their rounding of them.
  EXPECT_LT(difference(read, motion), 4 * table.bound.position);
}

TEST(ReadBack, WhatIsNoTableOrLogOfACamIsRefused) {
  EXPECT_THROW(cam_of_table({}, "read"), CamError);
  EXPECT_THROW(cam_of_log({}, "read"), CamError);
  Log log;
  log.axes.emplace_back().master = {0.0, 1.0, 2.0};
  log.axes[0].x = {0.0, 1.0, 2.0};
  EXPECT_THROW(cam_of_log(log, "read"), CamError);
}

TEST(ReadBack, TheSetPointsOfALogAreTheMotion) {
  const auto motion = smooth_motion();
  const auto machine = sim::read_machine(STICTION_SOURCE_DIR "/firmware/machine/shipped/cam-stand.toml");
  const auto run = run_cam<FixedSignals>(machine, motion, {.master_speed = 10.0, .cycles = 2});
  const auto read = compose(cam_of_log(run.log, "read"));
  EXPECT_NEAR(read.cam.cycle(), 360 * degree, rounding);
  // Where a cycle begins is known from a master that is recorded each tick: 10 rad/s in 62.5 us are 0.036 degrees, over
  // which a straight line replaces the motion; the spline between samples of half a degree is 1e-6 of the stroke off.
  const double begin = motion.curve(0.0), read_begin = read.curve(0.0);
  double largest = 0.0;
  for (int k = 0; k < 3600; ++k) {
    const double x = motion.curve.length() * k / 3600.0;
    largest = std::max(largest, std::fabs((read.curve(x) - read_begin) - (motion.curve(x) - begin)));
  }
  EXPECT_LT(largest, 1e-4 * 30 * degree);
}

}  // namespace
}  // namespace stiction::host
