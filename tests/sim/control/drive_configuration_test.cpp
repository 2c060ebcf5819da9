// From [drive] of a machine file to the drives' configuration.
#include "sim/control/drive_configuration.hpp"

#include <gtest/gtest.h>

#include <string>

#include "sim/control/conversion.hpp"
#include "sim/machine/drive_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

const std::string shipped = std::string(STICTION_SOURCE_DIR) + "/sim/machine/shipped/";

struct Read {
  sim::Machine machine;
  sim::DriveSetup setup;
};
Read read(const std::string& file, std::vector<std::string> set = {}) {
  Read r{sim::read_machine(shipped + file, {{}, set}), {}};
  r.setup = sim::read_drive_setup(shipped + file, r.machine, {{}, set});
  return r;
}

TEST(DriveConfiguration, HasTheFilesValuesInTheDrivesUnits) {
  const auto [machine, setup] =
      read("mcfv5050ln.toml", {"drive.axis.X.quick_stop_deceleration=8 m/s^2",
                               "drive.axis.X.homing.method=limit-negative", "drive.axis.X.homing.offset=-0.25 m",
                               "drive.axis.X.line.limit_negative=3", "drive.axis.X.brake_time=60 ms"});
  const auto c = sim::configure_drive<S>(machine.timing, machine.axes[0], setup.axes.at("X"));
  EXPECT_NEAR(sim::to_si(c.ramp.change), 8.0 * 62.5e-6, 4e-9);
  EXPECT_NEAR(sim::to_si(c.supervision.frozen_distance), 100e-6, 1e-9);
  EXPECT_NEAR(sim::to_si(c.supervision.encoder_jump), 5e-6, 1e-9);
  EXPECT_NEAR(sim::to_si(c.supervision.current_sum), 3.5, 1e-6);
  EXPECT_NEAR(sim::to_si(c.supervision.runaway_current), 14.0, 1e-6);
  // Half of what 14 A * 94 N/A make of 225 kg in 15 ticks.
  EXPECT_NEAR(sim::to_si(c.supervision.runaway_rise), 0.5 * 14.0 * 94.0 / 225.0 * 15.0 * 62.5e-6, 4e-9);
  EXPECT_TRUE(c.supervision.phases_sum);
  EXPECT_TRUE(c.supervision.current_measured);
  EXPECT_TRUE(c.supervision.negative_switch);
  EXPECT_FALSE(c.supervision.positive_switch);
  EXPECT_NEAR(sim::to_si(c.supervision.negative_from), -0.245, 1e-11);
  EXPECT_NEAR(sim::to_si(c.supervision.positive_by), 0.255, 1e-11);
  EXPECT_EQ(c.homing.method, stiction::HomingMethod::limit_negative);
  EXPECT_NEAR(sim::to_si(c.homing.offset), -0.25, 1e-11);
  EXPECT_NEAR(sim::to_si(c.homing.longest_way), 0.55, 1e-11);
  EXPECT_EQ(c.brake_ticks, 960u);
  EXPECT_EQ(c.stop_margin_ticks, 1600u);
}

TEST(DriveConfiguration, OfAForceSourceAsksNoCurrentSensors) {
  const auto [machine, setup] = read("emps.toml");
  const auto c = sim::configure_drive<S>(machine.timing, machine.axes[0], setup.axes.at("X"));
  EXPECT_FALSE(c.supervision.phases_sum);
  EXPECT_FALSE(c.supervision.current_measured);
  EXPECT_NEAR(sim::to_si(c.supervision.runaway_current), 2.0, 1e-6);  // V, a fifth of the limit
}

TEST(DriveConfiguration, HasOneADriveInTheMachinesOrder) {
  const auto [machine, setup] = read("mcfv5050ln.toml", {"drive.axis.Y.quick_stop_deceleration=5 m/s^2"});
  const auto drives = sim::configure_drives<sim::DoubleSignals>(machine, setup);
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_DOUBLE_EQ(drives[0].ramp.change.value, 10.0 * 62.5e-6);
  EXPECT_DOUBLE_EQ(drives[1].ramp.change.value, 5.0 * 62.5e-6);
}

void expect_refused(std::vector<std::string> set, const std::string& words) {
  const auto [machine, setup] = read("mcfv5050ln.toml", std::move(set));
  try {
    sim::configure_drives<S>(machine, setup);
    FAIL() << "taken";
  } catch (const sim::ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(DriveConfiguration, RefusesWhatTheFormatsCannotHoldOrResolve) {
  expect_refused({"drive.axis.X.quick_stop_deceleration=1e-4 m/s^2"}, "drive.axis.X.quick_stop_deceleration");
  expect_refused({"drive.axis.X.homing.creep_speed=1e-9 m/s"}, "drive.axis.X.homing.creep_speed");
  expect_refused({"drive.axis.Y.current_sum=3000 A"}, "drive.axis.Y.current_sum");
  expect_refused({"drive.axis.X.negative_end=0.3 m"}, "drive.axis.X.positive_end");
  expect_refused({"drive.axis.X.homing.creep_speed=1e-7 m/s"}, "drive.axis.X.homing.creep_speed");
}

}  // namespace
}  // namespace stiction::test
