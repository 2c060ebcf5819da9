// From [drive] of a machine file to the drives' configuration.
#include "firmware/machine/configuration/drive_configuration.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/file/drive_file.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

using S = FixedSignals;

struct Read {
  machine::Machine machine;
  machine::DriveSetup setup;
};

// A shipped machine with these lines in place of its own of [drive], which stand last.
Read read(const std::string& file, const std::string& drive = {}) {
  const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const auto path = std::filesystem::path(::testing::TempDir()) / fmt::format("{}_{}.toml", name, ::getpid());
  const auto shipped =
      machine::content_of(std::filesystem::path(STICTION_SOURCE_DIR) / "firmware/machine/shipped" / file);
  std::ofstream(path) << shipped.substr(0, shipped.find("[drive.")) << '\n' << drive;
  Read r{sim::read_machine(path, {}), {}};
  r.setup = machine::read_drive_setup(path, r.machine, {});
  std::filesystem::remove(path);
  return r;
}

TEST(DriveConfiguration, HasTheFilesValuesInTheDrivesUnits) {
  const auto [machine, setup] = read("mcfv5050ln.toml", R"([drive.axis.X]
quick_stop_deceleration = "8 m/s^2"
brake_time = "60 ms"
homing = { method = "limit-negative", offset = "-0.25 m" }
line = { limit_negative = 3 }
)");
  const auto c = machine::configure_drive<S>(machine.timing, machine.axes[0], setup.axes.at("X"));
  EXPECT_NEAR(machine::to_si(c.ramp.change), 8.0 * 62.5e-6, 4e-9);
  EXPECT_NEAR(machine::to_si(c.supervision.frozen_distance), 100e-6, 1e-9);
  EXPECT_NEAR(machine::to_si(c.supervision.encoder_jump), 5e-6, 1e-9);
  EXPECT_NEAR(machine::to_si(c.supervision.current_sum), 3.5, 1e-6);
  EXPECT_NEAR(machine::to_si(c.supervision.runaway_current), 14.0, 1e-6);
  // Half of what 14 A * 94 N/A make of 225 kg in 15 ticks.
  EXPECT_NEAR(machine::to_si(c.supervision.runaway_rise), 0.5 * 14.0 * 94.0 / 225.0 * 15.0 * 62.5e-6, 4e-9);
  EXPECT_TRUE(c.supervision.phases_sum);
  EXPECT_TRUE(c.supervision.current_measured);
  EXPECT_TRUE(c.supervision.negative_switch);
  EXPECT_FALSE(c.supervision.positive_switch);
  EXPECT_NEAR(machine::to_si(c.supervision.negative_from), -0.245, 1e-11);
  EXPECT_NEAR(machine::to_si(c.supervision.positive_by), 0.255, 1e-11);
  EXPECT_EQ(c.homing.method, stiction::HomingMethod::limit_negative);
  EXPECT_NEAR(machine::to_si(c.homing.offset), -0.25, 1e-11);
  EXPECT_NEAR(machine::to_si(c.homing.longest_way), 0.55, 1e-11);
  EXPECT_EQ(c.brake_ticks, 960u);
  EXPECT_EQ(c.stop_margin_ticks, 1600u);
}

TEST(DriveConfiguration, OfAForceSourceAsksNoCurrentSensors) {
  const auto [machine, setup] = read("emps.toml");
  const auto c = machine::configure_drive<S>(machine.timing, machine.axes[0], setup.axes.at("X"));
  EXPECT_FALSE(c.supervision.phases_sum);
  EXPECT_FALSE(c.supervision.current_measured);
  EXPECT_NEAR(machine::to_si(c.supervision.runaway_current), 2.0, 1e-6);  // V, a fifth of the limit
}

// 10 V * 35.15 N/V move 95.1 kg at 3.7 m/s^2: in 10 ms that is 370 um beside what the speed predicts.
TEST(DriveConfiguration, TakesNoMotionThatTheMotorCanMakeForAJumpOfTheEncoder) {
  const std::filesystem::path file = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/emps.toml";
  const machine::ReadOptions slow{"", {"timing.fast_period=10 ms", "timing.slow_period=10 ms"}};
  const auto machine = sim::read_machine(file, slow);
  const auto setup = machine::read_drive_setup(file, machine, slow);
  const auto c = machine::configure_drive<S>(machine.timing, machine.axes[0], setup.axes.at("X"));
  const double acceleration = 10.0 * 35.15065188248547 / 95.1089;
  EXPECT_GT(machine::to_si(c.supervision.encoder_jump), acceleration * 10e-3 * 10e-3);
  EXPECT_LT(machine::to_si(c.supervision.encoder_jump), 3.0 * acceleration * 10e-3 * 10e-3);
}

TEST(DriveConfiguration, HasTheDrivesInTheMachinesOrder) {
  const auto [machine, setup] = read("mcfv5050ln.toml", "[drive.axis.Y]\nquick_stop_deceleration = \"5 m/s^2\"\n");
  const auto drives = machine::configure_drives<machine::DoubleSignals>(machine, setup);
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_DOUBLE_EQ(drives[0].ramp.change.value, 10.0 * 62.5e-6);
  EXPECT_DOUBLE_EQ(drives[1].ramp.change.value, 5.0 * 62.5e-6);
}

struct Refused {
  const char *axis, *line, *key;
};

TEST(DriveConfiguration, RefusesWhatTheFormatsCannotHoldOrResolve) {
  for (const auto& [axis, line, key] :
       {Refused{"X", "quick_stop_deceleration = \"1e-4 m/s^2\"", "quick_stop_deceleration"},
        Refused{"X", "homing.creep_speed = \"1e-9 m/s\"", "homing.creep_speed"},
        Refused{"X", "homing.creep_speed = \"1e-7 m/s\"", "homing.creep_speed"},
        Refused{"Y", "current_sum = \"3000 A\"", "current_sum"},
        Refused{"X", "negative_end = \"0.3 m\"", "positive_end"}}) {
    const auto [machine, setup] = read("mcfv5050ln.toml", fmt::format("[drive.axis.{}]\n{}\n", axis, line));
    try {
      machine::configure_drives<S>(machine, setup);
      ADD_FAILURE() << line << " was taken";
    } catch (const machine::ConfigurationError& error) {
      EXPECT_NE(std::string(error.what()).find(fmt::format("drive.axis.{}.{}", axis, key)), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace stiction::test
