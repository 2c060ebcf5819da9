// Each row of the fault table that the axis itself watches: injected, detected after its number of ticks, reacted to,
// latched, reset.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/firmware/drive/axis_bench.hpp"

namespace stiction {
namespace {

using S = FixedSignals;
using test::FixedBench;
using test::si;

template <class T>
T next_above(T x) {
  return T::from_bounded_raw(std::int64_t{x.raw()} + 1);
}
template <class T>
T opposite(T x) {
  return T::from_bounded_raw(-std::int64_t{x.raw()});
}
S::Position as_position(S::Distance d) {
  return S::Position::from_raw(std::int64_t{d.raw()} << (S::Position::fraction_bits - S::Distance::fraction_bits));
}

// The smallest violation that the formats can show, applied to a bench at rest. The limit cycle, whose detection
// depends on the signal, stands in limit_cycle_test.cpp.
const std::map<Fault, std::function<void(FixedBench&)>> smallest_violation{
    {Fault::following_error,
     [](FixedBench& b) { b.set.position = as_position(next_above(b.axis.config().following_error_fault)); }},
    {Fault::over_current,
     [](FixedBench& b) { b.feedback.current[0] = next_above(b.axis.config().over_current_fault); }},
    {Fault::over_speed, [](FixedBench& b) { b.feedback.velocity = next_above(b.axis.config().over_speed_fault); }},
    {Fault::position_lost, [](FixedBench& b) { b.feedback.position_valid = false; }},
    {Fault::drive_input, [](FixedBench& b) { b.feedback.fault = true; }},
    {Fault::set_point, [](FixedBench& b) { b.set.valid = false; }},
};

// The speed fault is injected through an encoder that gives its own velocity.
FixedBench bench() {
  auto config = test::bench_config<S>();
  config.velocity_feedback = VelocityFeedback::given;
  FixedBench b(config);
  for (int i = 0; i < 5; ++i) b.tick();
  return b;
}

std::vector<FaultDescription> rows_with_a_detection_time() {
  std::vector<FaultDescription> rows;
  for (const auto& row : fault_table)
    if (row.detector == Detector::axis && row.detection_ticks > 0) rows.push_back(row);
  return rows;
}

class FaultOfTable : public ::testing::TestWithParam<FaultDescription> {};

TEST_P(FaultOfTable, TripsAfterItsDetectionTicksAndDisablesInTheSameTick) {
  auto b = bench();
  ASSERT_TRUE(b.command.enable);
  smallest_violation.at(GetParam().fault)(b);
  for (int i = 1; i < GetParam().detection_ticks; ++i) {
    b.tick();
    ASSERT_EQ(b.signals.fault, Fault::none) << "tick " << i;
    ASSERT_TRUE(b.command.enable) << "tick " << i;
  }
  const auto now = b.ticker.now_ns();
  b.tick();
  EXPECT_EQ(b.signals.fault, GetParam().fault);
  EXPECT_EQ(b.axis.fault(), GetParam().fault);
  EXPECT_EQ(b.axis.fault_time_ns(), now);
  EXPECT_FALSE(b.command.enable);
  for (const auto u : b.command.voltage) EXPECT_EQ(u.raw(), 0);
  for (const auto u : b.signals.u_phase) EXPECT_EQ(u.raw(), 0) << "the trace shows the command that was given";
}

TEST_P(FaultOfTable, StaysLatchedWithItsCauseGoneUntilTheNextStart) {
  auto b = bench();
  const auto calm = b.set;
  const auto calm_feedback = b.feedback;
  smallest_violation.at(GetParam().fault)(b);
  for (int i = 0; i < GetParam().detection_ticks; ++i) b.tick();
  const auto tripped_at = b.axis.fault_time_ns();
  b.set = calm;
  b.feedback = calm_feedback;
  for (int i = 0; i < 100; ++i) {
    b.tick();
    ASSERT_EQ(b.signals.fault, GetParam().fault);
    ASSERT_FALSE(b.command.enable);
  }
  EXPECT_EQ(b.axis.fault_time_ns(), tripped_at);
  b.start();
  b.tick();
  EXPECT_EQ(b.signals.fault, Fault::none);
  EXPECT_TRUE(b.command.enable);
}

TEST_P(FaultOfTable, TripsAgainAfterAStartWithItsCauseStillThere) {
  auto b = bench();
  smallest_violation.at(GetParam().fault)(b);
  for (int i = 0; i < GetParam().detection_ticks; ++i) b.tick();
  const auto faulty = b.feedback.position_valid;
  b.start();
  b.feedback.position_valid = faulty;
  for (int i = 0; i < GetParam().detection_ticks; ++i) b.tick();
  EXPECT_EQ(b.axis.fault(), GetParam().fault);
}

INSTANTIATE_TEST_SUITE_P(Axis, FaultOfTable, ::testing::ValuesIn(rows_with_a_detection_time()), [](const auto& row) {
  std::string name = row.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(FaultTable, HasAnInjectionForEveryRowAndARowForEveryNumber) {
  std::set<Fault> listed;
  for (const auto& row : fault_table) {
    listed.insert(row.fault);
    EXPECT_TRUE(row.detector != Detector::axis || row.fault == Fault::limit_cycle ||
                smallest_violation.contains(row.fault))
        << row.name;
    EXPECT_STREQ(name_of(row.fault), row.name);
  }
  EXPECT_EQ(listed.size(), fault_table.size());
  EXPECT_STREQ(name_of(Fault::none), "none");
}

TEST(FaultTable, KeepsItsNumbers) {
  // Logs and buses carry them: a changed number is a break of both.
  EXPECT_EQ(static_cast<int>(Fault::none), 0);
  EXPECT_EQ(static_cast<int>(Fault::following_error), 1);
  EXPECT_EQ(static_cast<int>(Fault::over_current), 2);
  EXPECT_EQ(static_cast<int>(Fault::over_speed), 3);
  EXPECT_EQ(static_cast<int>(Fault::position_lost), 4);
  EXPECT_EQ(static_cast<int>(Fault::drive_input), 5);
  EXPECT_EQ(static_cast<int>(Fault::set_point), 6);
  EXPECT_EQ(static_cast<int>(Fault::limit_cycle), 7);
}

// Exactly at a limit, in both signs, nothing trips however long it lasts.
void expect_calm(FixedBench& b) {
  for (int i = 0; i < 1000; ++i) {
    b.tick();
    ASSERT_EQ(b.axis.fault(), Fault::none) << "tick " << i;
    ASSERT_TRUE(b.command.enable) << "tick " << i;
  }
}

TEST(AxisFault, FollowingErrorDoesNotTripAtItsLimit) {
  for (const int sign : {1, -1}) {
    auto b = bench();
    const auto limit = as_position(b.axis.config().following_error_fault);
    b.set.position = sign > 0 ? limit : opposite(limit);
    expect_calm(b);
    EXPECT_EQ(std::abs(b.signals.e.raw()), b.axis.config().following_error_fault.raw());
  }
}

TEST(AxisFault, FollowingErrorTripsBelowItsNegativeLimit) {
  auto b = bench();
  b.set.position = as_position(opposite(next_above(b.axis.config().following_error_fault)));
  b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::following_error);
}

TEST(AxisFault, FollowingErrorTripsForAnErrorFarBeyondItsFormat) {
  auto b = bench();
  b.set.position = si<S::Position>(1000.0);  // 2000 times the range of Distance: it saturates, it does not wrap
  b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::following_error);
}

TEST(AxisFault, OverCurrentWatchesEachPhaseInBothSigns) {
  auto config = test::bench_config<S>();
  config.current_loop = CurrentLoop::three_phase;
  for (std::size_t phase = 0; phase < 3; ++phase)
    for (const int sign : {1, -1}) {
      FixedBench b(config);
      const auto limit = config.over_current_fault;
      b.feedback.current[phase] = sign > 0 ? limit : opposite(limit);
      b.feedback.current[(phase + 1) % 3] = sign > 0 ? opposite(limit) : limit;
      // Two phases at opposite limits make an amplitude of at most 2/3 * sqrt(3) times the limit: above it at some
      // positions. At this one it is below (sin 0 = 0, +-sin 60 deg).
      if (phase == 2 || phase == 0) {
        b.tick();
        EXPECT_EQ(b.axis.fault(), Fault::none) << "phase " << phase;
      }
      FixedBench above(config);
      above.feedback.current[phase] = sign > 0 ? next_above(limit) : opposite(next_above(limit));
      above.tick();
      EXPECT_EQ(above.axis.fault(), Fault::over_current) << "phase " << phase << " sign " << sign;
    }
}

TEST(AxisFault, OverCurrentWatchesTheAmplitudeOfThreePhasesToo) {
  auto config = test::bench_config<S>();
  config.current_loop = CurrentLoop::three_phase;
  FixedBench b(config);
  // Phases B and C at +-0.9 of the limit at position zero: amplitude 2/3 * 2 * 0.9 * sin 60 deg = 1.04 of the limit.
  b.feedback.current[1] = si<S::Current>(0.9 * 48.0);
  b.feedback.current[2] = si<S::Current>(-0.9 * 48.0);
  b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::over_current);
}

TEST(AxisFault, OverSpeedDoesNotTripAtItsLimit) {
  for (const int sign : {1, -1}) {
    auto b = bench();
    const auto limit = b.axis.config().over_speed_fault;
    b.feedback.velocity = sign > 0 ? limit : opposite(limit);
    expect_calm(b);
  }
}

TEST(AxisFault, OverSpeedIsSeenInTheEstimatedVelocity) {
  FixedBench b;  // differences of positions
  for (int i = 0; i < 40; ++i) {
    b.hold_at(1.74 * test::tick * i);
    b.tick();
    ASSERT_EQ(b.axis.fault(), Fault::none) << "tick " << i;
  }
  const double x = 1.74 * test::tick * 39;
  b.hold_at(x + 1.76 * test::tick);
  b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::over_speed);
}

TEST(AxisFault, TheFirstOfTwoFaultsStays) {
  auto b = bench();
  b.feedback.fault = true;
  b.tick();
  const auto first = b.axis.fault_time_ns();
  b.set.position = si<S::Position>(1.0);
  b.feedback.current[0] = si<S::Current>(1000.0);
  for (int i = 0; i < 20; ++i) b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::drive_input);
  EXPECT_EQ(b.axis.fault_time_ns(), first);
}

TEST(AxisFault, ASetPointThatIsNotValidIsNeverFollowed) {
  auto b = bench();
  b.set = {si<S::Position>(1e-3), {}, {}, false};
  b.tick();
  EXPECT_EQ(b.axis.fault(), Fault::set_point);
  EXPECT_FALSE(b.command.enable);
  EXPECT_EQ(b.command.voltage[0].raw(), 0);
}

TEST(AxisFault, ATripFromOutsideDisablesTheNextTick) {
  auto b = bench();
  b.axis.trip(Fault::drive_input, b.ticker.now_ns());
  b.tick();
  EXPECT_EQ(b.signals.fault, Fault::drive_input);
  EXPECT_FALSE(b.command.enable);
}

TEST(AxisFault, BeforeItsFirstStartAnAxisCommandsNothing) {
  Axis<S> axis(test::bench_config<S>());
  AxisSignals<S> signals;
  Feedback<S> feedback;
  feedback.position_valid = true;
  SetPoint<S> set{si<S::Position>(1e-3), {}, {}, true};
  for (std::int64_t i = 0; i < 40; ++i) {
    feedback.position_time_ns = i * test::tick_ns;
    const auto command = axis.tick(set, feedback, i * test::tick_ns, i % 16 == 0, signals);
    ASSERT_FALSE(command.enable);
    ASSERT_EQ(command.voltage[0].raw(), 0);
  }
}

}  // namespace
}  // namespace stiction
