// Composed motions, their file, and the operations on their list of segments.
#include "sim/cam/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/machine/file/machine_file.hpp"
#include "sim/cam/check.hpp"
#include "sim/cam/edit.hpp"
#include "sim/cam/motion_file.hpp"
#include "tests/sim/cam/random_motion.hpp"

namespace stiction::sim::cam {
namespace {

constexpr double pi = std::numbers::pi;

const char* const table_text = R"(schema = "stiction.cam/1"

[cam.table]
cycle = "360 deg"
modulo = "90 deg"
[[cam.table.segment]]
end = "180 deg"
stroke = "90 deg"
law = "modified sine"
parameters = { lambda = 0.4 }
[[cam.table.segment]]
end = "360 deg"
[[cam.table.track]]
name = "clamp"
on = "190 deg"
off = "350 deg"
on_compensation = "-2 ms"
hysteresis = "1 deg"

[cam.feed]
cycle = "360 deg"
slave = "linear"
[[cam.feed.segment]]
length = "120 deg"
to = "40 mm"
law = "3-4-5"
end_speed = "20 mm/rad"
[[cam.feed.segment]]
length = "240 deg"
to = "0 mm"
law = "hermite"
)";

std::string message_of(const std::string& text) {
  try {
    parse_motion_file("m.toml", text);
  } catch (const machine::MachineFileError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

TEST(CamMotionFile, HoldsSeveralCamsWithSegmentsAndTracks) {
  const auto cams = parse_motion_file("m.toml", table_text);
  ASSERT_EQ(cams.size(), 2u);
  const Cam &feed = cams[0], &table = cams[1];
  EXPECT_EQ(table.segments[0].law, "modified_sine");
  EXPECT_DOUBLE_EQ(table.segments[0].stroke, pi / 2);
  EXPECT_DOUBLE_EQ(table.cycle(), 2 * pi);
  ASSERT_EQ(table.tracks.size(), 1u);
  EXPECT_DOUBLE_EQ(table.tracks[0].on_compensation, -0.002);
  EXPECT_EQ(feed.slave, Coordinate::linear);
  EXPECT_DOUBLE_EQ(feed.segments[1].stroke, -0.04);
  const Motion motion = compose(feed);
  EXPECT_NEAR(motion.curve.derivative(2 * pi / 3, 1, Side::left), 0.02, 1e-15);
  EXPECT_NEAR(motion.curve.derivative(2 * pi / 3, 1), 0.02, 1e-15);
  EXPECT_NEAR(motion.curve(2 * pi / 3), 0.04, 1e-15);
}

TEST(CamMotionFile, RefusesWhatCannotBeWithItsPlace) {
  const auto message = [](const char* what, const char* with) { return message_of(replaced(table_text, what, with)); };
  EXPECT_EQ(message_of(table_text), "");
  EXPECT_EQ(message("stiction.cam/1", "stiction.cam/2"),
            "m.toml:1: schema: found \"stiction.cam/2\"; expected \"stiction.cam/1\"");
  EXPECT_NE(message("lambda = 0.4", "lambda = 1.0").find("lambda"), std::string::npos);
  EXPECT_NE(message("lambda = 0.4", "lambda = 0").find("lambda"), std::string::npos);
  EXPECT_NE(message("lambda = 0.4", "c = 0.0").find("c"), std::string::npos);
  EXPECT_NE(message("lambda = 0.4", "lamda = 0.4").find("did you mean \"lambda\"?"), std::string::npos);
  EXPECT_NE(message("end = \"360 deg\"", "end = \"100 deg\"").find("an end behind its begin"), std::string::npos);
  EXPECT_NE(message("end = \"180 deg\"", "length = \"0 deg\"").find("an end behind its begin"), std::string::npos);
  EXPECT_NE(message("stroke = \"90 deg\"", "stroke = \"80 deg\"").find("to close"), std::string::npos);
  EXPECT_NE(message("stroke = \"90 deg\"", "stroke = \"90 mm\"").find("m.toml:8: cam.table.segment[1].stroke"),
            std::string::npos);
  EXPECT_NE(message("law = \"modified sine\"", "law = \"modified sinus\"").find("did you mean"), std::string::npos);
  EXPECT_NE(message("stroke = \"90 deg\"", "stroke = \"nan deg\"").find("stroke"), std::string::npos);
  EXPECT_NE(message("law = \"3-4-5\"", "law = \"gutman\"\nparameters = { k = 1 }").find("unknown key"),
            std::string::npos);
  EXPECT_NE(message("law = \"3-4-5\"", "law = \"cubic\"\nend_jerk = \"1 m/rad^3\"").find("jerk"), std::string::npos);
  EXPECT_NE(message("law = \"3-4-5\"", "law = \"polynomial_asymmetric_6\"").find("forced speed"), std::string::npos);
  EXPECT_NE(message("to = \"40 mm\"", "to = \"1 nm\"").find("end_slope"), std::string::npos);
  EXPECT_NE(message("[cam.feed]", "[cam.\"a b\"]").find("letters, digits"), std::string::npos);
  EXPECT_NE(message("name = \"clamp\"", "name = 'a\"b'").find("without them"), std::string::npos);
  EXPECT_NE(message("off = \"350 deg\"", "off = [\"350 deg\", \"3 deg\"]").find("as many"), std::string::npos);
  EXPECT_NE(message("on = \"190 deg\"", "on = \"400 deg\"").find("0 to the cycle"), std::string::npos);
  EXPECT_NE(message("cycle = \"360 deg\"\nslave", "cycle = \"350 deg\"\nslave").find("fill the cycle"),
            std::string::npos);
}

TEST(CamMotionFile, IsWrittenAndReadBackToTheLastBit) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    RandomMotion random(seed);
    const Cam cam = seed % 2 == 0 ? random.rests(5) : random.septics(4);
    const auto back = parse_motion_file("m.toml", motion_text({cam}));
    ASSERT_EQ(back.size(), 1u);
    ASSERT_EQ(back[0].segments.size(), cam.segments.size());
    EXPECT_EQ(motion_text(back), motion_text({cam}));
    const Curve before = compose(cam).curve, after = compose(back[0]).curve;
    for (int k = 0; k <= 100; ++k) {
      const double x = before.end() * k / 100;
      EXPECT_NEAR(before(x), after(x), 1e-15);
    }
  }
}

TEST(CamMotionFile, ReadsTablesOfPointsInTheirUnits) {
  const auto cams = parse_motion_file("m.toml", R"(schema = "stiction.cam/1"
[cam.a]
cycle = "180 deg"
slave = "linear"
periodic = false
[[cam.a.segment]]
length = "180 deg"
[cam.a.segment.points]
master_unit = "deg"
slave_unit = "mm"
spline = "quintic_clamped"
rows = [[0, 5], [60, 10], [120, 12], [180, 20]]
)");
  const Curve curve = compose(cams[0]).curve;
  EXPECT_NEAR(curve(pi / 3), 0.005, 1e-15);  // from where the slave is
  EXPECT_NEAR(curve(pi), 0.015, 1e-15);
  EXPECT_NEAR(curve.derivative(pi, 1, Side::left), 0.0, 1e-12);
}

TEST(CamMotion, AHermiteSegmentContinuesItsNeighbours) {
  Cam cam{.name = "shear"};
  cam.segments = {{.length = 1.0, .stroke = 2.0, .law = "linear"}, {.length = 3.0, .stroke = -2.0, .law = "hermite"}};
  for (const auto& jump : jumps_of(compose(cam))) EXPECT_EQ(jump.jump.order, 3);
}

TEST(CamMotion, ARiseReturnEndsWhereItBegins) {
  Cam cam{.name = "press"};
  cam.segments = {{.length = 2.0, .stroke = 0.5, .law = "return_sine_4"}, {.length = 1.0}};
  const Curve curve = compose(cam).curve;
  EXPECT_NEAR(curve(1.0), 0.5, 1e-14);
  EXPECT_NEAR(curve(2.0), 0.0, 1e-14);
}

TEST(CamTrack, SwitchesWithCompensationHysteresisAndAroundTheSeam) {
  const Track track{"t", {{1.0, 2.0}, {5.0, 0.5}}, -0.1, 0.0, 0.01};
  EXPECT_FALSE(is_on(track, 0.95, 6.0, 0.0, false));
  EXPECT_TRUE(is_on(track, 0.95, 6.0, 1.0, false));  // a tenth earlier
  EXPECT_TRUE(is_on(track, 5.5, 6.0, 0.0, false));
  EXPECT_TRUE(is_on(track, 6.3, 6.0, 0.0, false));
  EXPECT_FALSE(is_on(track, 0.6, 6.0, 0.0, false));
  EXPECT_FALSE(is_on(track, 2.005, 6.0, 0.0, false));
  EXPECT_TRUE(is_on(track, 2.005, 6.0, 0.0, true));
}

TEST(CamEdit, RandomSequencesKeepTheListConsistent) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    RandomMotion random(500 + seed);
    Cam cam = random.rests(4);
    const double cycle = cam.cycle();
    for (int step = 0; step < 12; ++step) {
      const std::size_t n = cam.segments.size(), at = random.whole(n);
      const double from = cam.position_of(at), to = cam.position_of(at + 1), begin = cam.begin_of(at);
      switch (random.whole(4)) {
        case 0:
          cam = insert(cam, at,
                       {.length = 0.4 * cam.segments[at].length, .stroke = random.between(-1, 1), .law = "cubic"});
          EXPECT_NEAR(cam.position_of(at + 2), to, 1e-12);
          EXPECT_NEAR(cam.begin_of(at), begin, 1e-12);
          break;
        case 1:
          if (n > 2) cam = remove(cam, at);
          break;
        case 2:
          if (at + 1 < n) {
            const double x = 0.3 * begin + 0.7 * cam.begin_of(at + 2), end = cam.begin_of(at + 2);
            cam = drag_boundary(cam, at, x, 0.25);
            EXPECT_NEAR(cam.position_of(at + 1), 0.25, 1e-12);
            EXPECT_NEAR(cam.begin_of(at + 1), x, 1e-12);
            EXPECT_NEAR(cam.begin_of(at + 2), end, 1e-12);
          }
          break;
        default:
          cam = split(cam, begin + 0.37 * cam.segments[at].length);
          EXPECT_NEAR(cam.position_of(at), from, 1e-12);
          EXPECT_NEAR(cam.position_of(at + 2), to, 1e-12);
      }
      ASSERT_EQ(problem_of(cam), "");
      ASSERT_NEAR(cam.cycle(), cycle, 1e-11);
    }
  }
}

TEST(CamEdit, SplitLeavesTheMotionAtTheNewBoundaryAsItWas) {
  Cam cam{.name = "a"};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "modified_sine"},
                  {.length = 2.0, .stroke = -1.0, .law = "3-4-5"}};
  const Curve before = compose(cam).curve;
  const Cam two = split(cam, 0.7);
  ASSERT_EQ(two.segments.size(), 3u);
  const Motion motion = compose(two);
  for (int order = 0; order <= 2; ++order)
    for (const double x : {0.0, 0.7, 2.0, 3.1})
      EXPECT_NEAR(motion.curve.derivative(x, order), before.derivative(x, order), 1e-12);
  for (const auto& jump : jumps_of(motion)) EXPECT_EQ(jump.jump.order, 3);
}

TEST(CamEdit, AppendGrowsTheCycle) {
  Cam cam{.name = "a", .periodic = false};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "modified_sine"}};
  const Cam longer = append(cam, {.length = 1.0});
  EXPECT_EQ(longer.cycle(), 3.0);
  EXPECT_EQ(longer.position_of(2), 1.0);
}

TEST(CamEdit, RefusesWhatWouldBreakTheList) {
  Cam cam{.name = "a"};
  cam.segments = {{.length = 2.0, .stroke = 1.0, .law = "modified_sine"},
                  {.length = 2.0, .stroke = -1.0, .law = "cubic"}};
  EXPECT_THROW(append(cam, {.length = 1.0, .stroke = 1.0, .law = "cubic"}), CamError);
  EXPECT_THROW(insert(cam, 0, {.length = 2.0}), CamError);
  EXPECT_THROW(insert(cam, 5, {.length = 0.1}), CamError);
  EXPECT_THROW(remove(cam, 2), CamError);
  EXPECT_THROW(split(cam, 2.0), CamError);
  EXPECT_THROW(split(cam, 4.0), CamError);
  EXPECT_THROW(drag_boundary(cam, 0, 0.0, 1.0), CamError);
  EXPECT_THROW(drag_boundary(cam, 0, 4.0, 1.0), CamError);
  EXPECT_THROW(drag_boundary(cam, 1, 1.0, 1.0), CamError);
  Cam one{.name = "a", .periodic = false};
  one.segments = {cam.segments[0]};
  EXPECT_THROW(remove(one, 0), CamError);
}

}  // namespace
}  // namespace stiction::sim::cam
