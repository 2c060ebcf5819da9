// Cam switches against edges that are solved in double precision for masters at constant speed and at constant
// acceleration.
#include "stiction/motion/cam_switch.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/firmware/cam/cam_bench.hpp"
#include "tests/support/figure.hpp"

namespace stiction {
namespace {

using Track = CamSwitch::Track;

std::uint32_t place(double cycles) {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(std::ldexp(cycles, 32))));
}
std::int32_t ticks(double seconds) { return static_cast<std::int32_t>(std::lround(seconds * test::rate * 0x1p16)); }

// A master at `x` cycles with a speed and an acceleration in SI.
MasterPoint master(double x, double v, double a = 0.0) {
  return {MasterPosition::way(test::raw_position(x)), test::raw_velocity(v), test::raw_acceleration(a)};
}

struct Edge {
  double time;  // s
  bool on;
  int tick;
};

// The edges of one track behind x = x0 + v t + a t^2 / 2.
std::vector<Edge> edges(const Track& track, double x0, double v, double a, double seconds) {
  CamSwitch::State state;
  std::vector<Edge> found;
  const std::array<Track, 1> tracks{track};
  for (int k = 0; k < static_cast<int>(seconds * test::rate); ++k) {
    const double t = k / test::rate;
    const auto out = CamSwitch::step(tracks, state, master(x0 + v * t + a * t * t / 2, v + a * t, a), {});
    if (out.changed != 0 && k > 0)
      found.push_back({(k - std::ldexp(state.edge_time[0], -16)) / test::rate, (out.on & 1u) != 0, k});
  }
  return found;
}

// When x0 + v t + a t^2 / 2 is at `x`, less `lead`.
double time_at(double x, double x0, double v, double a) {
  const double way = x - x0;
  return std::abs(a) < 1e-12 ? way / v : (std::sqrt(v * v + 2 * a * way) - v) / a;
}

TEST(CamSwitch, EdgesComeWhenTheyAreDue) {
  double by_line = 0.0, by_stamp = 0.0, with_acceleration = 0.0;
  int seen = 0;
  for (const double speed : {0.3, 2.1667, 9.0, -0.7, -4.0})
    for (const double lead : {0.0, -8e-3, -30e-3, 5e-3})
      for (const double share : {0.0, 0.1, -0.1}) {
        // Speed changes by a tenth within the compensation.
        const double a = lead < 0.0 ? share * speed / -lead : 0.0;
        const bool back = speed < 0.0;
        const double x0 = back ? 0.93 : 0.02, first = 0.35, last = 0.6;
        const Track track{.first = place(first),
                          .last = place(last),
                          .on_compensation = ticks(lead),
                          .off_compensation = ticks(lead / 2)};
        const double on_at = time_at(back ? last : first, x0, speed, a) + lead;
        const double off_at = time_at(back ? first : last, x0, speed, a) + lead / 2;
        if (!(on_at > 1e-3) || !(off_at > on_at)) continue;  // past already, or the master turns before
        const auto found = edges(track, x0, speed, a, off_at + 1e-3);
        ASSERT_GE(found.size(), 2u) << speed << ' ' << lead << ' ' << share;
        const double due[2] = {on_at, off_at};
        for (int k = 0; k < 2; ++k) {
          EXPECT_EQ(found[static_cast<std::size_t>(k)].on, k == 0);
          const auto& edge = found[static_cast<std::size_t>(k)];
          const double line = edge.tick / test::rate - due[k];
          ++seen;
          by_line = std::max(by_line, std::abs(line) * test::rate);
          if (std::abs(share) < 1e-12)
            by_stamp = std::max(by_stamp, std::abs(edge.time - due[k]));
          else
            with_acceleration = std::max(with_acceleration, std::abs(edge.time - due[k]));
        }
      }
  EXPECT_GT(seen, 60);
  test::figure("cam switch: edges by line against exact ones, 10 % change of speed",
               fmt::format("{:.3f} ticks late of {} edges (bound 1)", by_line, seen));
  test::figure("cam switch: edges by time stamp, constant speed", fmt::format("{:.3f} us (bound 2)", by_stamp * 1e6));
  test::figure("cam switch: edges by time stamp, 10 % change of speed",
               fmt::format("{:.1f} us", with_acceleration * 1e6));
  EXPECT_LE(by_line, 1.0 + 1e-3);
  EXPECT_LE(by_stamp, 2e-6);
}

// Levels at single places, at a speed that is given.
class Levels {
 public:
  explicit Levels(const Track& track) : tracks_{track} {}
  bool at(double x, double v, const CamSwitch::Forces& forces = {}) {
    return (CamSwitch::step(tracks_, state_, master(x, v), forces).on & 1u) != 0;
  }

 private:
  std::array<Track, 1> tracks_;
  CamSwitch::State state_;
};

TEST(CamSwitch, ATrackWhoseFirstIsBehindItsLastIsOnAroundTheSeam) {
  Levels levels({.first = place(0.8), .last = place(0.1)});
  EXPECT_TRUE(levels.at(0.0, 1.0));
  EXPECT_TRUE(levels.at(0.0999, 1.0));
  EXPECT_FALSE(levels.at(0.1001, 1.0));
  EXPECT_FALSE(levels.at(0.7999, 1.0));
  EXPECT_TRUE(levels.at(0.8001, 1.0));
  EXPECT_TRUE(levels.at(5.9, 1.0));
  EXPECT_TRUE(levels.at(-3.05, 1.0));
  Levels whole({.first = place(0.3), .last = place(0.3)});
  for (const double x : {0.0, 0.3, 0.7}) EXPECT_TRUE(whole.at(x, 1.0));
}

TEST(CamSwitch, HysteresisHoldsWhatGoesBackAndNothingElse) {
  Levels levels({.first = place(0.3), .last = place(0.6), .hysteresis = place(0.01)});
  EXPECT_FALSE(levels.at(0.2999, 1.0));
  EXPECT_TRUE(levels.at(0.3001, 1.0));  // not late
  EXPECT_TRUE(levels.at(0.2999, -1.0));
  EXPECT_TRUE(levels.at(0.2901, -1.0));
  EXPECT_FALSE(levels.at(0.2899, -1.0));
  // Off by going back over the first place: on again only beyond it by the hysteresis.
  EXPECT_FALSE(levels.at(0.3099, 1.0));
  EXPECT_TRUE(levels.at(0.3101, 1.0));
  EXPECT_TRUE(levels.at(0.5999, 1.0));
  EXPECT_FALSE(levels.at(0.6001, 1.0));  // not late
  EXPECT_FALSE(levels.at(0.5901, -1.0));
  EXPECT_TRUE(levels.at(0.5899, -1.0));
  EXPECT_TRUE(levels.at(0.6099, 1.0));
  EXPECT_FALSE(levels.at(0.6101, 1.0));
  // A whole cycle on, the edge is where it was.
  EXPECT_FALSE(levels.at(1.2999, 1.0));
  EXPECT_TRUE(levels.at(1.3001, 1.0));
}

TEST(CamSwitch, AMasterThatTremblesOnAnEdgeSwitchesOnce) {
  CamSwitch::State state;
  const std::array<Track, 2> tracks{Track{.first = place(0.3), .last = place(0.6), .hysteresis = place(1e-3)},
                                    Track{.first = place(0.3), .last = place(0.6)}};
  int edges[2] = {};
  for (int k = 0; k < 1000; ++k) {
    const bool up = k % 2 == 0;
    const auto out = CamSwitch::step(tracks, state, master(0.3 + (up ? 4e-4 : -4e-4), up ? 1.0 : -1.0), {});
    for (unsigned n = 0; n < 2; ++n) edges[n] += static_cast<int>(out.changed >> n & 1u);
  }
  EXPECT_EQ(edges[0], 1);
  EXPECT_EQ(edges[1], 1000);
}

TEST(CamSwitch, ADurationEndsByTime) {
  for (const double speed : {1.0, -1.0}) {
    const Track track{.first = place(0.5), .duration = ticks(7.3e-3), .kind = CamSwitch::Kind::duration};
    const auto found = edges(track, speed > 0 ? 0.4 : 0.6, speed, 0.0, 0.2);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(found[0].on);
    EXPECT_NEAR(found[0].time, 0.1, 1e-6);
    EXPECT_FALSE(found[1].on);
    EXPECT_NEAR(found[1].time, 0.1 + 7.3e-3, 1e-6);
  }
}

TEST(CamSwitch, ADurationBeginsOnceACycleAtAnySpeed) {
  const Track track{.first = place(0.5), .duration = ticks(7.3e-3), .kind = CamSwitch::Kind::duration};
  for (const double speed : {0.08, 1.0, 30.0, -0.08, -30.0}) {
    const auto found = edges(track, 0.25, speed, 0.0, 2.0 / std::abs(speed));
    ASSERT_EQ(found.size(), 4u) << speed;
    const double first = (speed > 0 ? 0.25 : 0.75) / std::abs(speed);
    EXPECT_NEAR(found[0].time, first, 2e-6);
    EXPECT_NEAR(found[2].time, first + 1 / std::abs(speed), 2e-6);
  }
}

TEST(CamSwitch, ADirectionLetsOnlyItsOwnEdgesSwitchOn) {
  for (const auto kind : {CamSwitch::Kind::position, CamSwitch::Kind::duration})
    for (const double speed : {1.0, -1.0}) {
      Track track{.first = place(0.5), .last = place(0.55), .duration = ticks(1e-3), .kind = kind};
      const double x0 = speed > 0 ? 0.4 : 0.6;
      track.direction = speed > 0 ? CamSwitch::Direction::positive : CamSwitch::Direction::negative;
      EXPECT_EQ(edges(track, x0, speed, 0.0, 0.19).size(), 2u);
      track.direction = speed > 0 ? CamSwitch::Direction::negative : CamSwitch::Direction::positive;
      EXPECT_TRUE(edges(track, x0, speed, 0.0, 0.19).empty());
    }
}

TEST(CamSwitch, IsForcedAndDisabledWithoutForgettingItsPlace) {
  Levels levels({.first = place(0.3), .last = place(0.6)});
  EXPECT_TRUE(levels.at(0.4, 1.0));
  EXPECT_FALSE(levels.at(0.41, 1.0, {.enabled = 0}));
  EXPECT_FALSE(levels.at(0.42, 1.0, {.forced_off = 1}));
  EXPECT_TRUE(levels.at(0.43, 1.0));
  EXPECT_FALSE(levels.at(0.7, 1.0));
  EXPECT_TRUE(levels.at(0.71, 1.0, {.forced_on = 1}));
  EXPECT_TRUE(levels.at(0.72, 1.0, {.enabled = 0, .forced_on = 1}));
  EXPECT_FALSE(levels.at(0.73, 1.0, {.forced_on = 1, .forced_off = 1}));
}

TEST(CamSwitch, ACompensationThatOvertakesItsOtherEdgeLeavesNothing) {
  // At this speed the off edge comes 20 ms, 0.2 cycles, before the on edge.
  Levels levels({.first = place(0.5), .last = place(0.6), .off_compensation = ticks(-30e-3)});
  for (double x = 0.0; x < 1.0; x += 0.001) EXPECT_FALSE(levels.at(x, 10.0)) << x;
  // And 12 cycles of it are always on.
  Levels always({.first = place(0.5), .last = place(0.6), .on_compensation = ticks(-1.2)});
  for (double x = 0.0; x < 1.0; x += 0.001) EXPECT_TRUE(always.at(x, 10.0)) << x;
}

}  // namespace
}  // namespace stiction
