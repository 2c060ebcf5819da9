// 6065h and 6066h: a carriage that is held while its set-point goes on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {
namespace {

constexpr double error_window = 2e-3, lagging_speed = 0.2;  // m, m/s

ServedAxis with_window(std::uint32_t timeout_ticks, const StopCodes& stops = {}) {
  auto drive = ServedAxis::drive_config(stops, HomingMethod::none);
  drive.following_error = si<FixedSignals::Distance>(error_window);
  drive.following_error_ticks = timeout_ticks;
  auto cascade = ServedAxis::cascade();
  cascade.following_error_fault = si<FixedSignals::Distance>(2.0 * error_window);
  ServedAxis a(drive, cascade);
  EXPECT_TRUE(a.enable());
  a.stream(64, 0.0);
  return a;
}

// The lag grows by 5 um a tick, which no encoder that jumps does.
void slip(ServedAxis& a) {
  a.lag += 5e-6;
  a.stream(1, lagging_speed);
}
double error_of(const ServedAxis& a) { return machine::to_si(a.drive.set_position()) - a.x; }

// Ticks with more than the window up to the fault; the carriage shows where it is a tick later.
int ticks_to_the_fault(ServedAxis& a) {
  a.stream(800, lagging_speed);
  int beyond = 0;
  for (int i = 0; i < 2000 && a.drive.fault() == Fault::none; ++i) {
    const double x = a.x;
    slip(a);
    beyond += machine::to_si(a.drive.set_position()) - x > error_window ? 1 : 0;
  }
  return beyond;
}

TEST(FollowingError, BeyondItsWindowIsAStopByTheRampWhereTheEncoderIsTrusted) {
  auto a = with_window(0);
  EXPECT_EQ(ticks_to_the_fault(a), 1);
  EXPECT_EQ(a.drive.fault(), Fault::following_error);
  EXPECT_TRUE(a.drive.powered());
  EXPECT_EQ(a.drive.state(), DriveState::fault_reaction_active);
  double largest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    a.step();
    largest = a.drive.powered() ? std::max(largest, a.step_of_speed()) : largest;
  }
  EXPECT_LE(largest, ServedAxis::quick_deceleration * tick + 1e-8);
  EXPECT_EQ(a.drive.state(), DriveState::fault);
  EXPECT_FALSE(a.drive.powered());
  EXPECT_NEAR(a.v, 0.0, 1e-9);
}

TEST(FollowingError, MayBeExceededForItsTimeAndNoLonger) {
  auto a = with_window(100);
  EXPECT_EQ(ticks_to_the_fault(a), 101);
  EXPECT_TRUE(a.drive.powered());
  // For less, over and over: it begins again each time.
  auto b = with_window(100);
  b.stream(800, lagging_speed);
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 440; ++i) slip(b);  // to 2.2 mm
    EXPECT_GT(error_of(b), error_window);
    for (int i = 0; i < 440; ++i) {
      b.lag -= 5e-6;
      b.stream(1, lagging_speed);
    }
  }
  EXPECT_EQ(b.drive.fault(), Fault::none);
}

TEST(FollowingError, OfTwiceItsWindowTakesThePowerInTheSameTick) {
  auto a = with_window(16'000);
  ticks_to_the_fault(a);
  EXPECT_EQ(a.drive.fault(), Fault::following_error);
  EXPECT_FALSE(a.drive.powered());
  EXPECT_NEAR(a.lag, 2.0 * error_window, 5.0 * lagging_speed * tick);
  a.step();
  EXPECT_EQ(a.drive.state(), DriveState::fault);
  // The same in the stop that the window began.
  auto b = with_window(0);
  ticks_to_the_fault(b);
  ASSERT_TRUE(b.drive.powered());
  int ticks = 0;
  for (; ticks < 400 && b.drive.powered(); ++ticks) {
    b.lag += 8e-6;
    b.step();
  }
  EXPECT_FALSE(b.drive.powered());
  EXPECT_LT(ticks, 0.2 / ServedAxis::quick_deceleration / tick) << "before the stop is over";
  b.step();
  EXPECT_EQ(b.drive.state(), DriveState::fault);
}

// A force of up to 40 A, and an axis that answers to one above 20 A by more than 2 mm/s in 15 ticks the other way.
ServedAxis forced(double runaway_current = 5.0) {
  auto drive = ServedAxis::drive_config({}, HomingMethod::none);
  drive.following_error = si<FixedSignals::Distance>(error_window);
  drive.supervision.runaway_current = si<FixedSignals::Current>(runaway_current);
  drive.supervision.runaway_rise = si<FixedSignals::Velocity>(0.5e-3);
  auto cascade = ServedAxis::cascade();
  cascade.current_loop = CurrentLoop::none;  // its set current is the force
  ServedAxis a(drive, cascade);
  EXPECT_TRUE(a.enable());
  a.stream(864, lagging_speed);
  return a;
}
// Behind the set-point by a tick's `rate` (m) more than a tick ago.
void slip_faster(ServedAxis& a, double& rate) {
  rate += 12e-9;
  a.lag += rate;
  a.stream(1, lagging_speed);
}

TEST(FollowingError, OfAnAxisThatAcceleratesAgainstTheForceIsNoStopAsNoneCouldEnd) {
  for (const bool strong : {true, false}) {
    auto a = forced(strong ? 5.0 : 1000.0);
    double rate = 0.0;
    for (int i = 0; i < 2000 && a.drive.fault() == Fault::none; ++i) slip_faster(a, rate);
    EXPECT_EQ(a.drive.fault(), Fault::following_error);
    EXPECT_NEAR(a.lag, error_window, 3.0 * lagging_speed * tick) << "at the window";
    EXPECT_EQ(a.drive.powered(), !strong);
  }
}

TEST(FollowingError, TakesThePowerInItsStopWhereTheAxisAcceleratesAgainstTheForce) {
  for (const bool strong : {true, false}) {
    auto a = forced(strong ? 5.0 : 1000.0);
    ticks_to_the_fault(a);
    ASSERT_TRUE(a.drive.powered()) << "it falls behind at one speed";
    double rate = 5e-6;
    int ticks = 0;
    for (; ticks < 60 && a.drive.powered(); ++ticks) {
      a.lag += rate += 12e-9;
      a.step();
    }
    EXPECT_EQ(a.drive.powered(), !strong);
    EXPECT_LE(ticks, strong ? 50 : 60) << "31 ticks, and those to a change of 2 mm/s";
    EXPECT_EQ(a.drive.fault(), Fault::following_error);
    EXPECT_EQ(a.drive.state(), strong ? DriveState::fault : DriveState::fault_reaction_active);
  }
}

// Bit 13, mode by mode: of pp, pv and csp in the standard, reserved in csv; of a search it means the search itself,
// which this fault interrupts (bits 13, 12, 10: 0, 0, 1). It stays with the fault and goes with its reset.
TEST(FollowingError, IsBit13OfTheStatuswordInTheModesThatHaveIt) {
  struct Row {
    OperationMode mode;
    bool shown;
  };
  for (const auto& row : {Row{OperationMode::profile_position, true}, Row{OperationMode::profile_velocity, true},
                          Row{OperationMode::cyclic_position, true}, Row{OperationMode::cyclic_velocity, false},
                          Row{OperationMode::homing, false}}) {
    SCOPED_TRACE(static_cast<int>(row.mode));
    const bool homing = row.mode == OperationMode::homing;
    auto drive = ServedAxis::drive_config({}, homing ? HomingMethod::limit_positive : HomingMethod::none);
    drive.following_error = si<FixedSignals::Distance>(error_window);
    ServedAxis a(drive, ServedAxis::cascade());
    ASSERT_TRUE(a.enable());
    a.remote.ask(row.mode);
    a.remote.ask_target(si<FixedSignals::Position>(0.45));
    a.remote.ask_velocity(si<FixedSignals::Velocity>(lagging_speed));
    a.stream(64, 0.0);
    // Of pp and homing the same bit begins the motion.
    a.remote.ask(controlword::enable_operation | controlword::new_set_point_bit);
    ticks_to_the_fault(a);
    ASSERT_EQ(a.drive.fault(), Fault::following_error);
    EXPECT_EQ(a.shows(0x2000), row.shown) << "in the tick of the fault";
    a.coasts = false;
    a.stream(4000, 0.0);
    ASSERT_EQ(a.drive.state(), DriveState::fault);
    EXPECT_EQ(a.shows(0x2000), row.shown) << "without power";
    if (homing) {
      EXPECT_EQ(a.statusword() & 0x3400, 0x0400) << "a search is interrupted";
    }
    a.remote.ask(controlword::disable_voltage);
    a.step();
    a.remote.ask(controlword::fault_reset);
    a.step();
    ASSERT_EQ(a.drive.state(), DriveState::switch_on_disabled);
    EXPECT_FALSE(a.shows(0x2000)) << "behind the reset";
  }
}

TEST(FollowingError, IsBit13AlsoWhereItCameInTheStopOfADifferentFault) {
  auto a = with_window(0);
  a.stream(800, lagging_speed);
  a.trip = Fault::missed_deadline;
  a.step();
  a.trip = Fault::none;
  EXPECT_FALSE(a.shows(0x2000));
  for (int i = 0; i < 300 && a.drive.powered(); ++i) {
    a.lag += 9e-6;
    a.step();
  }
  EXPECT_FALSE(a.drive.powered());
  EXPECT_EQ(a.drive.fault(), Fault::missed_deadline);
  EXPECT_TRUE(a.shows(0x2000));
}

TEST(FollowingError, CoastsWhere605EhSaysSo) {
  auto a = with_window(0, {.fault_reaction = 0});
  ticks_to_the_fault(a);
  EXPECT_FALSE(a.drive.powered());
}

}  // namespace
}  // namespace stiction::test
