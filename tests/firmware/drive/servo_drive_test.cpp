// An axis as a drive where its source is not the bus: what it does by itself when modes, faults and feedback come as
// they should not.
#include "stiction/drive/servo_drive.hpp"

#include <gtest/gtest.h>

#include "tests/firmware/drive/served_axis.hpp"

namespace stiction::test {
namespace {

using enum DriveState;
using S = FixedSignals;

ServedAxis searching() {
  ServedAxis a({}, HomingMethod::limit_positive);
  EXPECT_TRUE(a.enable());
  a.direct_mode = OperationMode::homing;
  a.remote.ask(controlword::enable_operation | controlword::homing_start_bit);
  a.run(800);
  EXPECT_NEAR(a.set_speed, ServedAxis::search_speed, 1e-8);
  return a;
}

// The programme itself changes the mode without a look at the motion.
TEST(ServoDrive, LeavesHomingByARampWhateverItsSourceDoes) {
  auto a = searching();
  a.direct_mode = OperationMode::cyclic_position;
  double largest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    a.step();
    largest = std::max(largest, a.step_of_speed());
  }
  EXPECT_LE(largest, ServedAxis::slow_deceleration * tick + 1e-8);
  EXPECT_EQ(a.set_speed, 0.0);
  EXPECT_EQ(a.drive.state(), operation_enabled);
}

TEST(ServoDrive, SearchesItsTravelAndThenFailsWithTheBitsOfHoming) {
  auto a = searching();
  bool moving = false;
  for (int i = 0; i < 200'000 && a.drive.fault() == Fault::none; ++i) a.step();
  EXPECT_EQ(a.drive.fault(), Fault::homing);
  for (int i = 0; i < 2000 && a.drive.powered(); ++i) {
    moving |= (a.drive.statusword() & 0x3400) == 0x2000;
    a.step();
  }
  EXPECT_TRUE(moving) << "an error, and not at rest yet";
  EXPECT_FALSE(a.drive.powered());
  EXPECT_EQ(a.drive.statusword() & 0x3400, 0x2400) << "the error stays, at rest and without power";
}

TEST(ServoDrive, PutsTheMachinesZeroWhereHomingFindsIt) {
  ServedAxis a({}, HomingMethod::here, 0.3);
  EXPECT_EQ(a.drive.origin(), S::Position{});
  ASSERT_TRUE(a.enable());
  a.direct_mode = OperationMode::homing;
  a.remote.ask(controlword::enable_operation | controlword::homing_start_bit);
  a.run(100);
  ASSERT_TRUE(a.drive.referenced());
  EXPECT_NEAR(machine::to_si(a.drive.origin()), 0.3, 1e-6);
  EXPECT_NEAR(machine::to_si(a.drive.position()), 0.0, 1e-6);
}

TEST(ServoDrive, HoldsBehindAQuickStopAndGoesOnFromThere) {
  StopCodes codes;
  codes.quick_stop = 6;
  ServedAxis a(codes);
  ASSERT_TRUE(a.enable());
  a.direct_mode = OperationMode::cyclic_position;
  a.remote.ask(controlword::quick_stop);
  a.run(1000);
  EXPECT_EQ(a.drive.state(), quick_stop_active);
  EXPECT_TRUE(a.drive.powered());
  a.remote.ask(controlword::enable_operation);
  a.run(5);
  EXPECT_EQ(a.drive.state(), operation_enabled);
}

TEST(ServoDrive, MakesNoStopSlowerThatIsUnderWay) {
  StopCodes codes;
  codes.fault_reaction = 1;
  ServedAxis a(codes);
  ASSERT_TRUE(a.enable());
  a.stream(800, 0.2);
  a.remote.ask(controlword::quick_stop);
  a.run(20);
  a.trip = Fault::missed_deadline;
  a.run(3);
  EXPECT_NEAR(a.step_of_speed(), ServedAxis::quick_deceleration * tick, 1e-8);
}

TEST(ServoDrive, TakesThePowerWithASecondFaultAndForAFaultThatTheTableDoesNotHave) {
  ServedAxis a({}, HomingMethod::here);
  ASSERT_TRUE(a.enable());
  a.direct_mode = OperationMode::homing;
  a.remote.ask(controlword::enable_operation | controlword::homing_start_bit);
  a.run(100);
  ASSERT_TRUE(a.drive.referenced());
  a.trip = Fault::missed_deadline;
  a.step();
  EXPECT_TRUE(a.drive.powered());
  a.trip = Fault::encoder_jump;  // on top of it
  a.step();
  EXPECT_FALSE(a.drive.powered());
  EXPECT_EQ(a.drive.fault(), Fault::missed_deadline);
  a.trip = Fault::bus_off;  // a third one is not recorded
  a.step();
  a.trip = Fault::none;
  a.remote.ask(controlword::disable_voltage);
  a.run(300);
  a.remote.ask(controlword::fault_reset);
  a.run(3);
  EXPECT_EQ(a.drive.fault(), Fault::none);
  EXPECT_FALSE(a.drive.referenced()) << "lost by the second one";
  a.trip = Fault::missed_deadline;  // without power there is nothing to stop
  a.step();
  EXPECT_FALSE(a.drive.powered());
  ServedAxis b;
  ASSERT_TRUE(b.enable());
  b.trip = static_cast<Fault>(200);
  b.step();
  EXPECT_FALSE(b.drive.powered());
  ServedAxis absolute;
  absolute.trip = Fault::encoder_jump;
  absolute.step();
  absolute.trip = Fault::none;
  absolute.run(300);
  absolute.remote.ask(controlword::fault_reset);
  absolute.run(3);
  EXPECT_TRUE(absolute.drive.referenced()) << "an absolute encoder has nothing to lose";
}

TEST(ServoDrive, TakesNoResetWhileACauseHolds) {
  const auto reset = [](ServedAxis& a) {
    a.remote.ask(controlword::disable_voltage);
    a.run(400);
    a.remote.ask(controlword::fault_reset);
    a.run(3);
    return a.drive.fault() == Fault::none;
  };
  ServedAxis lost;
  ASSERT_TRUE(lost.enable());
  lost.position_valid = false;
  lost.run(10);
  EXPECT_EQ(lost.drive.fault(), Fault::position_lost);
  EXPECT_FALSE(reset(lost));
  lost.position_valid = true;
  EXPECT_TRUE(reset(lost));
  ServedAxis invalid;
  ASSERT_TRUE(invalid.enable());
  invalid.direct_mode = OperationMode::cyclic_position;
  invalid.run(3);
  invalid.set_point_valid = false;
  invalid.run(3);
  EXPECT_EQ(invalid.drive.fault(), Fault::set_point);
  EXPECT_FALSE(reset(invalid));
  invalid.set_point_valid = true;
  EXPECT_TRUE(reset(invalid));
  ServedAxis fast;
  ASSERT_TRUE(fast.enable());
  fast.trip = Fault::clock_jump;
  fast.step();
  fast.trip = Fault::none;
  fast.v = 2.0;  // beyond over_speed
  EXPECT_FALSE(reset(fast));
  fast.v = 0.0;
  EXPECT_TRUE(reset(fast));
}

TEST(ServoDrive, TakesThePowerBehindItsMarginFromAStopThatDoesNotStand) {
  ServedAxis a;
  ASSERT_TRUE(a.enable());
  a.wobble = 0.2e-6;  // 6 mm/s each eighth tick
  a.stream(100, 0.0);
  a.remote.ask(controlword::shutdown);
  int ticks = 0;
  for (; ticks < 4000 && a.drive.powered(); ++ticks) a.step();
  EXPECT_NEAR(ticks, 1600, 5);
}

TEST(ServoDrive, WaitsForItsBrake) {
  auto config = ServedAxis::drive_config({}, HomingMethod::none);
  config.brake_ticks = 50;
  ServedAxis a(config, ServedAxis::cascade());
  ASSERT_TRUE(a.enable());
  int opening = 0;
  for (; opening < 200 && !a.drive.follows(); ++opening) a.stream(1, 0.0);
  EXPECT_NEAR(opening, 50, 2);
  a.remote.ask(controlword::shutdown);
  int closing = 0;
  for (int i = 0; i < 2000 && a.drive.powered(); ++i) {
    closing += a.drive.brake_released() ? 0 : 1;
    a.stream(1, 0.0);
  }
  EXPECT_NEAR(closing, 50, 2);
  EXPECT_FALSE(a.drive.brake_released());
}

TEST(ServoDrive, KnowsTheForceOfEveryKindOfMotor) {
  for (const auto kind : {CurrentLoop::direct, CurrentLoop::none, CurrentLoop::three_phase}) {
    auto cascade = ServedAxis::cascade();
    cascade.current_loop = kind;
    ServedAxis a(ServedAxis::drive_config({}, HomingMethod::none), cascade);
    EXPECT_TRUE(a.enable());
    a.position_valid = false;
    a.step();
    a.position_valid = true;
    a.run(10);
    EXPECT_EQ(a.drive.fault(), Fault::none);
  }
}

TEST(ServoDrive, HasTheModesThatItsBitsSay) {
  std::uint32_t bits = 0;
  for (int mode = 0; mode < 12; ++mode)
    if (is_supported(mode)) bits |= 1u << (mode - 1);
  EXPECT_EQ(bits, 0b11'1010'0101u);
  // Bits 16 and on are the manufacturer's: modes -1 and -2.
  for (int mode = -4; mode < 0; ++mode) EXPECT_EQ(is_supported(mode), mode >= -2);
  EXPECT_EQ(supported_mode_bits(), bits | 0b11u << 16);
}

}  // namespace
}  // namespace stiction::test
