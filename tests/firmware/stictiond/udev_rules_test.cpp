// Rules for udev from a machine file, in a folder of the shape of sysfs.
#include "firmware/stictiond/udev_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "firmware/stictiond/configuration.hpp"

namespace stiction::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class UdevRules : public ::testing::Test {
 protected:
  UdevRules() {
    fs::create_directories(sys_ / "devices/platform/INT34C5:00/gpiochip0");
    fs::create_directories(sys_ / "devices/platform/1f00098000.pwm/pwm/pwmchip0");
    fs::create_directories(sys_ / "bus/gpio/devices");
    fs::create_directory_symlink(sys_ / "devices/platform/INT34C5:00/gpiochip0", sys_ / "bus/gpio/devices/gpiochip0");
  }
  ~UdevRules() override { fs::remove_all(sys_); }

  const fs::path sys_ = fs::temp_directory_path() / ("stiction_udev_" + std::to_string(::getpid()));
};

TEST_F(UdevRules, NameTheDeviceOfTheChipAndNoOther) {
  machine::GpioSetup setup;
  setup.chip = "servo-lines";
  const auto text = drive::udev_rules(setup, "gpiochip0", sys_);
  EXPECT_THAT(text, HasSubstr(R"(SUBSYSTEM=="gpio", KERNEL=="gpiochip*", KERNELS=="INT34C5:00", GROUP="stiction")"));
  EXPECT_THAT(text, Not(HasSubstr("pwm")));
}

TEST_F(UdevRules, NameTheDeviceOfThePwmChip) {
  machine::GpioSetup setup;
  setup.pwm_chip = (sys_ / "devices/platform/1f00098000.pwm/pwm/pwmchip0").string();
  EXPECT_THAT(drive::udev_rules(setup, "gpiochip0", sys_), HasSubstr(R"(SUBSYSTEM=="pwm", KERNELS=="1f00098000.pwm")"));
}

TEST_F(UdevRules, AreRefusedForAChipThatIsNotThere) {
  EXPECT_THROW((void)drive::udev_rules({}, "gpiochip7", sys_), drive::StartRefused);
}

}  // namespace
}  // namespace stiction::test
