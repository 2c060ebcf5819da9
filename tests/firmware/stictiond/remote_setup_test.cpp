// What a machine file may say of set-points from outside, and what is refused with what was found.
#include "firmware/stictiond/remote_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "firmware/machine/configuration/conversion.hpp"

namespace stiction::test {
namespace {

using ::testing::HasSubstr;

drive::DriveConfiguration configuration(std::vector<std::string> settings) {
  drive::DriveOptions options;
  options.machine = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";
  options.set = std::move(settings);
  return drive::read_configuration(options);
}
const std::vector<std::string> served{"drive.can_server.interface=vcan1", "drive.axis.X.server_node=11",
                                      "drive.axis.Y.server_node=12"};
std::vector<std::string> with(std::vector<std::string> settings) {
  settings.insert(settings.begin(), served.begin(), served.end());
  return settings;
}
std::string refusal(const std::vector<std::string>& settings) {
  try {
    drive::check_remote(configuration(settings));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(RemoteSetup, NeedsANodeOfItsOwnForEveryAxis) {
  EXPECT_THAT(refusal({"drive.can_server.interface=vcan1", "drive.axis.X.server_node=1"}),
              HasSubstr("found no drive.axis.Y.server_node; expected"));
  EXPECT_THAT(refusal(with({"drive.axis.Y.server_node=11"})),
              HasSubstr("found drive.axis.Y.server_node = 11 a second time"));
}

TEST(RemoteSetup, NeedsAPeriodOfWholeSlowTicksInWhichTheAxisDoesNotGoTooFar) {
  const auto slow = [&](const std::string& period) {
    return refusal(with({"drive.can_server.frames=positions", "drive.can_server.period=" + period}));
  };
  EXPECT_EQ(slow("1 ms"), "");
  EXPECT_EQ(slow("4 ms"), "");
  EXPECT_THAT(slow("1.5 ms"), HasSubstr("found 1.5 ms; expected a whole multiple of timing.slow_period, 1 ms"));
  EXPECT_THAT(slow("15 ms"), HasSubstr("expected a displacement of at most 15.625 mm between set-points"));
}

TEST(RemoteSetup, NeedsABusThatCarriesItsFrames) {
  // Two axes each millisecond: SYNC, targets and states are 52 % of 1 Mbit/s, with everything else 102 %.
  EXPECT_EQ(refusal(with({"drive.can_server.frames=positions"})), "");
  EXPECT_THAT(refusal(served), HasSubstr("found a load of 102 % at worst; expected at most 80 %"));
  EXPECT_EQ(refusal(with({"drive.can_server.period=2 ms"})), "");
  EXPECT_EQ(refusal(with({"drive.can_server.data_bit_rate=5e6 bit/s"})), "");
  EXPECT_THAT(refusal(with({"drive.can_server.frames=positions", "drive.can_server.bit_rate=250000 bit/s"})),
              HasSubstr("found a load of 206 % at worst"));
}

TEST(RemoteSetup, SharesTheBusOfTheNodesWithTheSameBitRatesAndWithoutASecondSync) {
  EXPECT_THAT(refusal(with({"drive.can_server.interface=can0"})),
              HasSubstr("on one interface, can0; expected the same bit rates"));
  const auto c = configuration(with({"drive.can_server.interface=can0", "drive.can_server.data_bit_rate=8e6 bit/s"}));
  EXPECT_FALSE(drive::can_server_config(c).sends_sync);
  EXPECT_THAT(refusal(with({"drive.can_server.interface=can0", "drive.can_server.data_bit_rate=8e6 bit/s",
                            "drive.can_server.sync=followed"})),
              HasSubstr("found drive.can_server.sync = \"followed\" on the interface of [drive.can], can0"));
  const auto config = drive::can_config(c);
  EXPECT_THAT(config.others, ::testing::IsSupersetOf({0x40bu, 0x38cu, 0x50bu, 0x48cu, 0x30bu}));
  EXPECT_THAT(config.others, ::testing::IsSupersetOf({0x000u, 0x08bu, 0x58cu, 0x60bu, 0x70bu}));
  EXPECT_THAT(config.others, ::testing::Not(::testing::Contains(0x080u))) << "the drive alone sends SYNC there";
  EXPECT_EQ(config.others.size(), 1U + 2U * 11U);
  EXPECT_EQ(drive::can_bus_budget(c).rows.size(), 3U + 4U);
  const auto apart = configuration(served);
  EXPECT_TRUE(drive::can_server_config(apart).sends_sync);
  EXPECT_TRUE(drive::can_config(apart).others.empty());
}

TEST(RemoteSetup, TakesLimitsFromTheMachine) {
  const auto axes = drive::remote_axes(configuration(with({"drive.axis.X.profile_jerk_time=20 ms"})));
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_NEAR(machine::to_si(axes[0].fastest.velocity), 80.0 / 60.0, 1e-8);
  EXPECT_NEAR(machine::to_si(axes[0].fastest.deceleration), 20.0 * 62.5e-6, 1e-8);
  EXPECT_NEAR(machine::to_si(axes[0].interpolation.largest_way), 80.0 / 60.0 * 1e-3 * 1.01, 1e-11);
  EXPECT_EQ(axes[0].profile.smoothing_bits, 8);  // 320 ticks: 256 are nearer than 512
  EXPECT_TRUE(axes[0].streamed);
  EXPECT_FALSE(drive::remote_axes(configuration({}))[0].streamed);
}

TEST(RemoteSetup, TakesTheLimitsOfTorqueFromTheMachine) {
  // X of the cross table: 70 A, 94 N/A, 225 kg, 600 A s/m, gain 83.3 1/s, 80 m/min, 10 m/s^2 of a controlled stop.
  const auto torque = drive::remote_axes(configuration(served))[0].torque;
  EXPECT_NEAR(machine::to_si(torque.most), 70.0, 1e-5);
  EXPECT_NEAR(machine::to_si(torque.slope), 70.0 / 160.0, 1e-5) << "10 ms";
  EXPECT_NEAR(machine::to_si(torque.speed), 80.0 / 60.0, 1e-8);
  EXPECT_NEAR(machine::to_si(torque.deceleration), 10.0 * 62.5e-6, 1e-8);
  EXPECT_NEAR(machine::to_si(torque.speed_of_current) / (94.0 / 225.0 * 62.5e-6), 1.0, 1e-2);
  EXPECT_NEAR(machine::to_si(torque.gain), 600.0, 1e-3);
  EXPECT_EQ(torque.stiffness_bits, 9) << "31 1/s, less than half of the axis' own";
  const auto set = drive::remote_axes(
      configuration(with({"drive.axis.X.torque_slope=500 A/s", "drive.axis.X.max_motor_speed=0.5 m/s"})))[0];
  EXPECT_NEAR(machine::to_si(set.torque.slope), 500.0 * 62.5e-6, 1e-5);
  EXPECT_NEAR(machine::to_si(set.torque.speed), 0.5, 1e-8);
  EXPECT_THAT(
      refusal(with({"drive.axis.X.max_motor_speed=2 m/s"})),
      HasSubstr("drive.axis.X.max_motor_speed: found 2 m/s; expected at most axis.X.max_velocity, 1.33333 m/s"));
}

TEST(RemoteSetup, SendsActualTorquesWhereTheyAreAskedFor) {
  const auto bytes_of_state = [](const std::vector<std::string>& set) {
    for (const auto& frame : drive::can_server_frames(configuration(set)))
      if (frame.name == "state") return frame.bytes;
    return 0;
  };
  EXPECT_EQ(bytes_of_state(served), 6);
  EXPECT_EQ(bytes_of_state(with({"drive.can_server.frames=torques"})), 8);
  const auto page = drive::dbc_page(configuration(with({"drive.can_server.frames=torques"})));
  EXPECT_THAT(page, HasSubstr("BO_ 907 X_state: 8 drive\n"));
}

TEST(RemoteSetup, DescribesItsFramesInTheDbc) {
  const std::string both = drive::dbc_page(configuration(served));
  EXPECT_THAT(both, HasSubstr("BO_ 1035 X_target: 6 controller\n SG_ controlword : 0|16@1+ (1,0)"));
  EXPECT_THAT(both, HasSubstr("BO_ 908 Y_state: 6 drive\n"));
  EXPECT_THAT(both, HasSubstr("BO_ 128 sync: 8 drive\n"));
  EXPECT_THAT(both, ::testing::Not(HasSubstr("BO_ 1035 14;")));  // classical beside the nodes' CAN FD
  const std::string alone = drive::dbc_page(configuration(with({"drive.can="})));
  EXPECT_THAT(alone, HasSubstr("BO_ 128 sync: 0 drive\n"));
}

}  // namespace
}  // namespace stiction::test
