// From the keys of [drive.gpio] and [drive.axis.NAME.line] to the GPIO backend's configuration.
#include "firmware/stictiond/gpio_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "firmware/machine/file/drive_file.hpp"
#include "hal/gpio/lines.hpp"
#include "sim/machine_file.hpp"
#include "tests/firmware/machine/machine_text.hpp"

namespace stiction::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* drive_text = R"([drive.gpio]
chip = "servo-lines"
pwm_chip = "/sys/class/pwm/pwmchip0"
pwm_period = "50 us"
dc_link = "48 V"
bias = "pull-down"
watchdog = 9
watchdog_period = "2 ms"
[drive.axis.B.line]
enable = 7
brake = 8
limit_negative = 3
limit_positive = 4
limit_active = "low"
quadrature_a = 0
quadrature_b = 1
quadrature_increment = "5 um"
quadrature_rate = "8000 1/s"
pwm_channel = 2
)";

struct Read {
  machine::Machine machine;
  machine::DriveSetup setup;
};

Read read(const std::string& text) {
  const auto file = fs::temp_directory_path() / ("stiction_gpio_setup_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << text;
  Read result;
  result.machine = sim::read_machine(file);
  result.setup = machine::read_drive_setup(file, result.machine);
  fs::remove(file);
  return result;
}

std::string refusal(const Read& read) {
  try {
    (void)drive::gpio_configuration(read.setup, read.machine);
  } catch (const hal::GpioError& error) {
    return error.what();
  }
  return "taken";
}

TEST(GpioSetup, CarriesEveryKeyOfTheMachineFileToTheBackend) {
  const auto [machine, setup] = read(std::string(machine::test::small_machine) + drive_text);
  ASSERT_TRUE(drive::has_gpio_lines(setup, machine));
  const auto config = drive::gpio_configuration(setup, machine);
  EXPECT_EQ(config.chip, "servo-lines");
  EXPECT_EQ(config.bias, hal::Bias::pull_down);
  EXPECT_EQ(config.watchdog.line.offset, 9);
  EXPECT_EQ(config.watchdog.period_ns, 2'000'000);
  ASSERT_EQ(config.axes.size(), 1u);
  const auto& [lines, encoder, pwm] = config.axes[0];
  EXPECT_EQ(lines.name, "B");
  EXPECT_EQ(lines.enable.offset, 7);
  EXPECT_FALSE(lines.enable.active_low);
  EXPECT_EQ(lines.limit_negative.offset, 3);
  EXPECT_TRUE(lines.limit_negative.active_low);
  EXPECT_TRUE(lines.limit_positive.active_low);
  EXPECT_FALSE(lines.home.wired());
  EXPECT_EQ(encoder.b.offset, 1);
  EXPECT_DOUBLE_EQ(encoder.increment, 5e-6);
  EXPECT_DOUBLE_EQ(encoder.rate, 8000.0);
  EXPECT_EQ(encoder.settle_ns, 50'000);
  EXPECT_EQ(pwm.chip, "/sys/class/pwm/pwmchip0");
  EXPECT_EQ(pwm.first_channel, 2);
  EXPECT_EQ(pwm.half_bridges, 2);
  EXPECT_EQ(pwm.period_ns, 50'000);
  EXPECT_DOUBLE_EQ(pwm.dc_link, 48.0);
}

TEST(GpioSetup, FindsNoLinesWhereNoneAreNamed) {
  const auto [machine, setup] = read(machine::test::small_machine);
  EXPECT_FALSE(drive::has_gpio_lines(setup, machine));
  EXPECT_THAT(refusal({machine, setup}), ::testing::HasSubstr("no table [drive.gpio]"));
}

TEST(GpioSetup, TakesALineForAWatchdogAlone) {
  const auto [machine, setup] =
      read(std::string(machine::test::small_machine) + "[drive.gpio]\nchip = \"lines\"\nwatchdog = 2\n");
  EXPECT_TRUE(drive::has_gpio_lines(setup, machine));
  EXPECT_EQ(drive::watchdog_config(setup).line.offset, 2);
}

TEST(GpioSetup, TakesALineForATrackOfTheCamSwitchAlone) {
  const std::string track = "[drive.cam_switch.track2]\nline = 4\nactive = \"low\"\nfirst = 0.1\nlast = 0.4\n";
  const auto [machine, setup] =
      read(std::string(machine::test::small_machine) + "[drive.gpio]\nchip = \"lines\"\n" + track);
  EXPECT_TRUE(drive::has_gpio_lines(setup, machine));
  const auto lines = drive::track_lines(setup);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_FALSE(lines[0].wired());
  EXPECT_EQ(lines[1].offset, 4);
  EXPECT_TRUE(lines[1].active_low);
}

TEST(GpioSetup, RefusesAnAxisWhoseCurrentIsControlledInTheDrive) {
  auto both = read(std::string(machine::test::small_machine) + drive_text);
  both.machine.axes[0].motor.model = machine::MotorModel::synchronous;
  EXPECT_THAT(refusal(both), ::testing::HasSubstr("axis B: its current controllers need the phase currents"));
}

TEST(GpioSetup, RefusesAMachineWithoutAPwmChip) {
  auto both = read(std::string(machine::test::small_machine) + drive_text);
  both.setup.gpio->pwm_chip.reset();
  EXPECT_THAT(refusal(both), ::testing::HasSubstr("names no pwm_chip"));
}

}  // namespace
}  // namespace stiction::test
