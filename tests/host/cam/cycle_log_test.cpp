// Logs of cycles that say nothing of a vibration: the sentence names what was found and where.
#include "host/cam/cycle_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace stiction::host {
namespace {

constexpr double degree = std::numbers::pi / 180.0, speed = 780.0 * degree;

// A cycle at 130/min in steps of a millisecond: 30 degrees in the first half, with an encoder of 0.015 degrees that is
// 3 ms late.
struct Recorded {
  std::vector<double> time, master, load, set;

  explicit Recorded(double stop_at = -1.0, double largest = 1.0) {
    double at = 0.0;
    for (double t = 0.0; at < 359.0 * degree; t += 1e-3) {
      const bool stopped = stop_at >= 0.0 && t >= stop_at && t < stop_at + 0.25;
      at += stopped ? 0.0 : speed * 1e-3;
      time.push_back(t);
      master.push_back(at);
      set.push_back(way(at));
      load.push_back(std::min(largest, 0.015 * degree * std::round(way(at - 3e-3 * speed) / (0.015 * degree))));
    }
  }
  static double way(double master) {
    const double x = std::clamp(master / std::numbers::pi, 0.0, 1.0);
    return 30.0 * degree * (x < 0.5 ? 2.0 * x * x : 1.0 - 2.0 * (1.0 - x) * (1.0 - x));
  }
  CycleSamples samples() const { return {time, master, load, set}; }
};

TEST(CycleLog, ACycleThatTurnsAndAnEncoderThatFollowsAreUsed) {
  const Recorded good;
  EXPECT_FALSE(stop_in_cycle(good.samples(), speed, 1.0 / degree, "°"));
  EXPECT_FALSE(encoder_at_its_end(good.samples(), 30.0 * degree, 1.0 / degree, "°"));
  // Without set-points nothing is known of the encoder.
  const Recorded stuck(-1.0, 10.0 * degree);
  EXPECT_FALSE(encoder_at_its_end({stuck.time, stuck.master, stuck.load, {}}, 30.0 * degree, 1.0 / degree, "°"));
}

TEST(CycleLog, AMasterThatWasStoppedIsNamedWithItsPlace) {
  // After 0.3 s, at 234 degrees, for 250 ms.
  const Recorded stopped(0.3);
  const auto said = stop_in_cycle(stopped.samples(), speed, 1.0 / degree, "°");
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("found a master that stops at 2"), std::string::npos) << *said;
  EXPECT_NE(said->find("expected a cycle without a stop"), std::string::npos) << *said;
}

TEST(CycleLog, AnEncoderAtTheEndOfItsRangeIsNamedWithItsPlace) {
  const Recorded stuck(-1.0, 10.0 * degree);
  const auto said = encoder_at_its_end(stuck.samples(), 30.0 * degree, 1.0 / degree, "°");
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("found an encoder at the load that stays where it is from the master's 7"), std::string::npos)
      << *said;
  EXPECT_NE(said->find("expected one that follows"), std::string::npos) << *said;
}

// Of 0.24 s in steps of a millisecond, with an encoder of 0.015 degrees: a vibration at 15.2 Hz, of a load that is said
// to have 14.5, about a place that moves by `way` degrees, cut off above `end` degrees.
struct RecordedDwell {
  std::vector<double> time, master, load;

  explicit RecordedDwell(double way, double end = 90.0, double amplitude = 0.8) {
    constexpr double length = 0.24, frequency = 2.0 * std::numbers::pi * 15.2;
    for (double t = 0.0; t < length; t += 1e-3) {
      time.push_back(t);
      master.push_back(speed * t);
      const double place = 30.0 + way * t / length + amplitude * std::exp(-1.3 * t) * std::sin(frequency * t + 0.4);
      load.push_back(degree * 0.015 * std::round(std::min(place, end) / 0.015));
    }
  }
  CycleSamples samples() const { return {time, master, load, {}}; }
};

DwellJudge judge() { return {2.0 * std::numbers::pi * 14.5, 0.015 * degree, 30.0 * degree, 1.0 / degree, "°"}; }

TEST(CycleLog, ADwellThatVibratesAtRestIsUsed) {
  for (const double amplitude : {0.0, 0.05, 0.8, 4.0}) {
    const RecordedDwell dwell(0.0, 90.0, amplitude);
    EXPECT_FALSE(motion_in_dwell(dwell.samples(), judge())) << amplitude;
    EXPECT_FALSE(cut_off_in_dwell(dwell.samples(), judge())) << amplitude;
  }
  // Friction lets a load creep a little.
  EXPECT_FALSE(motion_in_dwell(RecordedDwell(0.3).samples(), judge()));
  const CycleSamples none{};
  EXPECT_FALSE(motion_in_dwell(none, judge()));
  EXPECT_FALSE(cut_off_in_dwell(none, judge()));
}

TEST(CycleLog, ALoadThatStillMovesInTheDwellIsNamedWithItsWay) {
  for (const double way : {-3.0, 1.0, 3.0}) {
    const auto said = motion_in_dwell(RecordedDwell(way).samples(), judge());
    ASSERT_TRUE(said) << way;
    // To a tenth.
    const double found = std::stod(said->substr(said->find("by ") + 3));
    EXPECT_NEAR(found, way, 0.1 * std::fabs(way)) << *said;
    EXPECT_NE(said->find("° in the dwell; expected an axis at rest there"), std::string::npos) << *said;
  }
}

TEST(CycleLog, AnEncoderThatCutsOffTheVibrationIsNamedWithItsEnd) {
  const auto said = cut_off_in_dwell(RecordedDwell(0.0, 30.0).samples(), judge());
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("goes no further than 30 °"), std::string::npos) << *said;
}

TEST(CycleLog, AMasterAtAnotherSpeedIsNamedWithBoth) {
  const Recorded good;
  EXPECT_FALSE(other_speed(good.samples(), 1.01 * speed, 1.0 / degree, "°"));
  EXPECT_FALSE(other_speed({}, speed, 1.0 / degree, "°"));
  const auto said = other_speed(good.samples(), 600.0 * degree, 1.0 / degree, "°");
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("found a master that turns at 780 °/s; expected the 600 °/s"), std::string::npos) << *said;
}

}  // namespace
}  // namespace stiction::host
