// The encoder's side of the GPIO backend without a kernel: the state machine over all its transitions, and the tracker
// over edges as a kernel gives them, in order, late, lost and too many.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>
#include <vector>

#include "hal/gpio/index_latch.hpp"
#include "hal/gpio/quadrature_tracker.hpp"

namespace stiction::test {
namespace {

using hal::Edge;
using hal::QuadratureDecoder;
using hal::QuadratureFault;
using hal::QuadratureTracker;
using Step = QuadratureDecoder::Step;
using Track = QuadratureTracker::Track;

constexpr std::array<std::array<bool, 2>, 4> gray{{{false, false}, {true, false}, {true, true}, {false, true}}};

TEST(QuadratureDecoder, CountsByTheNeighboursInGrayCodeAndTakesNothingElseForAStep) {
  constexpr std::array expected{Step::none, Step::forward, Step::illegal, Step::backward};
  for (std::size_t from = 0; from < 4; ++from)
    for (std::size_t turn = 0; turn < 4; ++turn) {
      const auto& start = gray[from];
      const auto& end = gray[(from + turn) % 4];
      QuadratureDecoder decoder(start[0], start[1]);
      EXPECT_EQ(decoder.set(end[0], end[1], 7), expected[turn]) << from << " to " << (from + turn) % 4;
      EXPECT_EQ(decoder.count(), (std::array{0, 1, 0, -1})[turn]);
      EXPECT_EQ(decoder.illegal(), turn == 2 ? 1u : 0u);
      EXPECT_EQ(decoder.last_edge_ns(), turn == 0 ? 0 : 7);
      EXPECT_EQ(decoder.a(), end[0]);
      EXPECT_EQ(decoder.b(), end[1]);
    }
}

// Edges of a wheel that follows `path` (counts, in steps of one) with an edge every `interval_ns` from `first_ns` on.
struct Edges {
  std::vector<Edge> a, b;
};
Edges edges_of(const std::vector<std::int64_t>& path, std::int64_t interval_ns, std::int64_t first_ns = 1000) {
  Edges edges;
  std::int64_t count = 0;
  std::int64_t time_ns = first_ns;
  for (const auto next : path) {
    const auto& from = gray[static_cast<std::uint64_t>(count) % 4];
    const auto& to = gray[static_cast<std::uint64_t>(next) % 4];
    auto& track = from[0] != to[0] ? edges.a : edges.b;
    track.push_back({time_ns, from[0] != to[0] ? to[0] : to[1]});
    count = next;
    time_ns += interval_ns;
  }
  return edges;
}

std::vector<std::int64_t> there_and_back(std::int64_t end) {
  std::vector<std::int64_t> path;
  for (std::int64_t i = 1; i <= end; ++i) path.push_back(i);
  for (std::int64_t i = end - 1; i >= -end; --i) path.push_back(i);
  return path;
}

std::vector<std::int64_t> upwards(std::int64_t end) {
  std::vector<std::int64_t> path(static_cast<std::size_t>(end));
  std::iota(path.begin(), path.end(), 1);
  return path;
}

// Gives the tracks to the tracker a few edges at a time, all of A before all of B, as two queues are read.
void play(QuadratureTracker& tracker, const Edges& edges, std::int64_t tick_ns, std::int64_t end_ns) {
  std::size_t a = 0, b = 0;
  for (std::int64_t now = tick_ns; now <= end_ns; now += tick_ns) {
    while (a < edges.a.size() && edges.a[a].time_ns <= now) tracker.add(Track::a, edges.a[a++]);
    while (b < edges.b.size() && edges.b[b].time_ns <= now) tracker.add(Track::b, edges.b[b++]);
    tracker.advance(now);
  }
}

TEST(QuadratureTracker, CountsEveryEdgeThereAndBackWithTheTracksReadOneAfterTheOther) {
  QuadratureTracker tracker(0.0, 50'000);
  tracker.start(false, false);
  play(tracker, edges_of(there_and_back(500), 10'000), 62'500, 20'000'000);
  EXPECT_EQ(tracker.fault(), QuadratureFault::none);
  EXPECT_EQ(tracker.count(), -500);
  EXPECT_EQ(tracker.last_edge_ns(), 1000 + 1499 * 10'000);
}

TEST(QuadratureTracker, CountsARandomWalkAsItWasWalked) {
  std::mt19937 random(7);
  std::vector<std::int64_t> path;
  std::int64_t count = 0;
  for (int i = 0; i < 20'000; ++i) path.push_back(count += random() % 2 == 0 ? 1 : -1);
  QuadratureTracker tracker(0.0, 50'000);
  tracker.start(false, false);
  play(tracker, edges_of(path, 9'000), 62'500, 190'000'000);
  EXPECT_EQ(tracker.fault(), QuadratureFault::none);
  EXPECT_EQ(tracker.count(), count);
}

TEST(QuadratureTracker, HoldsAnEdgeBackUntilAnOlderOneCanNoMoreFollow) {
  QuadratureTracker tracker(0.0, 50'000);
  tracker.start(false, false);
  tracker.add(Track::b, {30'000, true});
  EXPECT_EQ(tracker.advance(62'500), 12'500);
  EXPECT_EQ(tracker.count(), 0);
  tracker.add(Track::a, {20'000, true});  // its interrupt's thread ran later than that of B
  tracker.advance(125'000);
  EXPECT_EQ(tracker.fault(), QuadratureFault::none);
  EXPECT_EQ(tracker.count(), 2);
}

TEST(QuadratureTracker, SaysThatAnEdgeCameAfterNewerOnesHadBeenCounted) {
  QuadratureTracker tracker(0.0, 50'000);
  tracker.start(false, false);
  tracker.add(Track::b, {1'000, true});
  tracker.advance(62'500);
  tracker.add(Track::a, {900, true});
  EXPECT_EQ(tracker.fault(), QuadratureFault::late_edge);
}

// Every single edge of a motion taken out, on either track.
TEST(QuadratureTracker, SaysThatAnEdgeIsMissingWhicheverItIs) {
  const auto whole = edges_of(there_and_back(20), 10'000);
  for (const bool of_a : {true, false})
    for (std::size_t missing = 0; missing + 1 < (of_a ? whole.a : whole.b).size(); ++missing) {
      auto edges = whole;
      auto& track = of_a ? edges.a : edges.b;
      track.erase(track.begin() + static_cast<std::ptrdiff_t>(missing));
      QuadratureTracker tracker(0.0, 50'000);
      tracker.start(false, false);
      play(tracker, edges, 62'500, 1'000'000);
      EXPECT_EQ(tracker.fault(), QuadratureFault::lost_edge) << (of_a ? "A " : "B ") << missing;
    }
}

TEST(QuadratureTracker, TakesBothTracksAtOnceForADisturbance) {
  QuadratureTracker tracker(0.0, 0);
  tracker.start(false, false);
  tracker.add(Track::a, {1'000, true});
  tracker.add(Track::b, {1'000, true});
  tracker.advance(2'000);
  EXPECT_EQ(tracker.fault(), QuadratureFault::both_changed);
}

// Intervals of 60 and 140 us are 10000 edges a second: tracks that are not quite a quarter apart are no over-speed.
TEST(QuadratureTracker, AllowsTheStatedRateWithUnevenTracksAndRefusesATenthMore) {
  for (const bool fast : {false, true}) {
    auto edges = edges_of(upwards(400), fast ? 90'000 : 100'000);
    for (auto& edge : edges.b) edge.time_ns -= fast ? 0 : 40'000;
    QuadratureTracker tracker(10e3, 50'000);
    tracker.start(false, false);
    play(tracker, edges, 62'500, 80'000'000);
    EXPECT_EQ(tracker.fault(), fast ? QuadratureFault::too_fast : QuadratureFault::none);
  }
}

TEST(QuadratureTracker, SaysThatMoreEdgesCameThanItHolds) {
  QuadratureTracker tracker(0.0, 1'000'000);
  tracker.start(false, false);
  for (int i = 0; i < 65; ++i) tracker.add(Track::a, {1'000 + i, i % 2 == 0});
  EXPECT_EQ(tracker.fault(), QuadratureFault::queue_full);
}

TEST(QuadratureTracker, KeepsTheFirstFaultUntilItStartsAgain) {
  QuadratureTracker tracker(0.0, 0);
  tracker.start(false, false);
  tracker.trip(QuadratureFault::queue_full);
  tracker.trip(QuadratureFault::lost_edge);
  EXPECT_EQ(tracker.fault(), QuadratureFault::queue_full);
  EXPECT_STREQ(hal::name_of(tracker.fault()), "edge queue full");
  tracker.start(true, true);
  EXPECT_EQ(tracker.fault(), QuadratureFault::none);
  tracker.add(Track::a, {10, false});
  tracker.advance(20);
  EXPECT_EQ(tracker.count(), 1);
}

TEST(QuadratureTracker, LatchesTheCountAtTheRisingEdgeOfTheIndex) {
  QuadratureTracker tracker(0.0, 50'000);
  tracker.start(false, false);
  const auto edges = edges_of(there_and_back(30), 10'000);
  // Between the edges to 17 and to 18, and again where the motion comes back.
  tracker.add(Track::index, {1000 + 16 * 10'000 + 5'000, true});
  tracker.add(Track::index, {1000 + 17 * 10'000 + 5'000, false});
  play(tracker, edges, 62'500, 1'000'000);
  EXPECT_EQ(tracker.take_index(), 17);
  EXPECT_EQ(tracker.take_index(), std::nullopt);
}

Feedback<FixedSignals> at(std::int64_t raw, std::int64_t time_ns, bool valid = true) {
  return {.position = FixedSignals::Position::from_raw(raw), .position_time_ns = time_ns, .position_valid = valid};
}

TEST(IndexLatch, ReadsThePositionAtATimeOffTheStraightLineThroughTheNewestSamples) {
  hal::IndexLatch latch;
  EXPECT_FALSE(latch.position_at(0));
  latch.observe(at(1000, 62'500));
  EXPECT_FALSE(latch.position_at(62'500));
  latch.observe(at(2000, 125'000));
  latch.observe(at(2000, 125'000));         // not new
  latch.observe(at(9000, 187'500, false));  // not valid
  EXPECT_EQ(latch.position_at(93'750)->raw(), 1500);
  EXPECT_EQ(latch.position_at(156'250)->raw(), 2500);
  EXPECT_FALSE(latch.position_at(125'000 + 20'000'000)) << "too long ago";
}

TEST(IndexLatch, GivesNoPositionAcrossAJumpThatItsArithmeticCannotHold) {
  hal::IndexLatch latch;
  latch.observe(at(0, 62'500));
  latch.observe(at(std::int64_t{1} << 60, 125'000));
  EXPECT_FALSE(latch.position_at(93'750));
}

}  // namespace
}  // namespace stiction::test
