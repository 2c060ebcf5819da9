// A PLC that engages a cam, switches the table, phases and disengages: over Modbus registers and over the objects of
// CANopen, in the drive's own time. Truth is the motion in double precision at the place that the master shows.
#include "tests/firmware/stictiond/served_cam.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiction::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Bus, ServedCam, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedCam, IsEngagedSwitchedPhasedAndLeft) {
  ASSERT_TRUE(enable_in(-1));
  EXPECT_FALSE(shows(busy));
  ASSERT_TRUE(write("master_speed", 130.0 / 60.0));
  run_until([&] { return std::abs(read("master_velocity") - 130.0 / 60.0) < 1e-5; });

  ASSERT_TRUE(write("cam_table", 1));
  ASSERT_TRUE(command(engage));
  EXPECT_EQ(read("cam_refusal"), 0.0);
  EXPECT_TRUE(shows(busy));
  run_until([&] { return shows(active | in_sync); });
  EXPECT_EQ(read("cam_followed"), 1.0);
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(0), 0.0, 2e-9);
  }
  EXPECT_TRUE(table.statusword(0) & statusword::target_bit);
  EXPECT_TRUE(table.statusword(0) & statusword::follows_bit);
  const double ends = read("cam_ends");
  step(1000);
  EXPECT_NEAR(read("cam_ends") - ends, 130.0 / 60.0, 1.0);

  // The second table, where the next cycle begins.
  ASSERT_TRUE(write("cam_table", 2));
  ASSERT_TRUE(write("cam_trigger", 3));
  ASSERT_TRUE(command(engage));
  run_until([&] { return read("cam_followed") == 2.0 && shows(in_sync); });
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(1), 0.0, 2e-9);
  }

  ASSERT_TRUE(write("cam_phase", 0.1));
  ASSERT_TRUE(command(phase));
  run_until([&] { return !table.cam->mode(0).phasing(); }, 8000);
  for (int k = 0; k < 500; ++k) {
    step();
    ASSERT_NEAR(off(1, 0.1), 0.0, 2e-9);
  }

  ASSERT_TRUE(command(leave));
  run_until([&] { return !shows(busy); });
  EXPECT_EQ(read("cam_followed"), 0.0);
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
  EXPECT_EQ(table.loop.fault(0), Fault::none);
  EXPECT_TRUE(table.powered(0));
  EXPECT_GT(largest_change, 1.0) << "m/s^2: it has moved";
}

TEST_P(ServedCam, ThatCannotBeIsRefusedWithAReasonAndNothingMoves) {
  ASSERT_TRUE(enable_in(-1));
  const double stands = table.set_position(0);
  const auto refused = [&](int reason) {
    EXPECT_TRUE(command(engage));
    step(200);
    EXPECT_EQ(read("cam_refusal"), reason);
    EXPECT_TRUE(table.statusword(0) & statusword::limit_bit);
    EXPECT_FALSE(shows(active));
    EXPECT_EQ(table.set_position(0), stands);
  };
  ASSERT_TRUE(write("cam_table", 3));
  refused(8);
  ASSERT_TRUE(write("cam_table", 1));
  ASSERT_TRUE(write("gear_numerator", 20));
  refused(3);
  ASSERT_TRUE(write("gear_numerator", 1));
  ASSERT_TRUE(write("cam_slave_scale", 20.0));
  refused(10);
  ASSERT_TRUE(write("cam_slave_scale", 1.0));
  ASSERT_TRUE(write("cam_slave_offset", 0.5));
  refused(10);
  // 30 mm in 5 ms.
  ASSERT_TRUE(write("cam_slave_offset", -0.03));
  ASSERT_TRUE(write("cam_approach", 1));
  ASSERT_TRUE(write("cam_time", 5e-3));
  refused(4);
  ASSERT_TRUE(write("cam_time", 0.5));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  EXPECT_EQ(read("cam_refusal"), 0.0);
  EXPECT_NEAR(table.set_position(0), 0.06, 1e-9);
  EXPECT_FALSE(write("cam_trigger", 5)) << "no such number";
  EXPECT_FALSE(write("cam_command", 9));
}

TEST_P(ServedCam, OfAnAxisThatIsNotEnabledInItsModeIsRefused) {
  ASSERT_TRUE(write("cam_command", engage));
  step(5);
  EXPECT_EQ(read("cam_refusal"), 9.0);
  EXPECT_FALSE(shows(busy));
}

TEST_P(ServedCam, IsLeftForAHaltAndForADifferentMode) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", 1.0));
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(300);
  ASSERT_TRUE(write("controlword", 0x10f));
  run_until([&] { return !shows(busy); });
  EXPECT_TRUE(table.powered(0));
  ASSERT_TRUE(write("controlword", 0x0f));
  step(500);
  EXPECT_FALSE(shows(active)) << "not by itself";
  ASSERT_TRUE(command(engage));
  run_until([&] { return shows(in_sync); });
  step(150);
  ASSERT_TRUE(write("mode_of_operation", 1));
  run_until([&] { return read("mode") == 1.0; });
  EXPECT_FALSE(shows(busy));
  EXPECT_EQ(machine::to_si(table.loop.drive(0).set_velocity()), 0.0);
}

TEST_P(ServedCam, AMasterIsHeldToItsLargestSpeed) {
  ASSERT_TRUE(enable_in(-1));
  ASSERT_TRUE(write("master_speed", -3.0));
  step(3000);
  EXPECT_NEAR(read("master_velocity"), -130.0 / 60.0, 1e-5);
}

// The master is an axis: Y follows X by a ratio of 1, in mode gear.
class ServedGear : public ServedCam {
 protected:
  ServedGear() : ServedCam({{}, "X", "0.1 m/s"}) { table.before_tick = {}; }

  void follow() {
    ASSERT_TRUE(enable_in(1, 0));
    ASSERT_TRUE(enable_in(-2, 1));
    step(50);
    ASSERT_TRUE(write("gear_way", 1.0, 1));
    ASSERT_TRUE(write("cam_options", 2, 1));
    ASSERT_TRUE(write("cam_command", engage, 1));
    step(20);
    ASSERT_EQ(read("cam_refusal", 1), 0.0);
    ASSERT_EQ(static_cast<unsigned>(read("cam_state", 1)) & (active | in_sync), unsigned{active | in_sync});
  }
  void move_master(double target, double speed) {
    ASSERT_TRUE(write("target_position", target));
    ASSERT_TRUE(write("profile_velocity", speed));
    ASSERT_TRUE(write("profile_acceleration", 1.0));
    ASSERT_TRUE(write("profile_deceleration", 1.0));
    ASSERT_TRUE(write("controlword", 0x1f));
    step(2);
    ASSERT_TRUE(write("controlword", 0x0f));
  }
};

INSTANTIATE_TEST_SUITE_P(Bus, ServedGear, ::testing::Bool(),
                         [](const auto& bus) { return std::string(bus.param ? "CANopen" : "Modbus"); });

TEST_P(ServedGear, FollowsAnAxisByItsRatio) {
  follow();
  const double apart = table.set_position(1) - table.set_position(0);
  move_master(0.04, 0.08);
  double worst = 0.0;
  for (int k = 0; k < 1200; ++k) {
    step();
    worst = std::max(worst, std::abs(table.set_position(1) - table.set_position(0) - apart));
  }
  EXPECT_NEAR(table.set_position(0), 0.04, 1e-6);
  EXPECT_NEAR(table.set_position(1) - table.set_position(0), apart, 1e-9);
  // What the estimator makes of a jerk of 1 m/s^2 in 16 ms over its 8 ticks.
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(table.loop.fault(1), Fault::none);
}

TEST_P(ServedGear, AMasterWithoutPowerIsLost) {
  follow();
  move_master(0.04, 0.08);
  step(200);
  ASSERT_TRUE(write("controlword", 0));
  step(20);
  EXPECT_EQ(table.loop.fault(1), Fault::master_lost);
  step(1500);
  EXPECT_FALSE(table.powered(1));
}

TEST_P(ServedGear, AMasterBeyondItsSpeedIsAFault) {
  follow();
  move_master(0.02, 0.15);
  run_until([&] { return table.loop.fault(1) != Fault::none; }, 1000);
  EXPECT_EQ(table.loop.fault(1), Fault::master_too_fast);
  EXPECT_NEAR(std::abs(table.set_velocity(0)), 0.1, 2e-3);
  step(1500);
  EXPECT_FALSE(table.powered(1));
}

TEST_P(ServedGear, TheMasterItselfHasNoModeOfIt) {
  ASSERT_TRUE(enable_in(1, 0));
  write("mode_of_operation", -2);
  step(100);
  EXPECT_EQ(read("mode"), 1.0);
}

}  // namespace
}  // namespace stiction::test
