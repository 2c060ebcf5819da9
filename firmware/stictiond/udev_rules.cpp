#include "firmware/stictiond/udev_rules.hpp"

#include <fmt/format.h>

#include "firmware/stictiond/configuration.hpp"

namespace stiction::drive {
namespace {

namespace fs = std::filesystem;

// The kernel's name of the device that a chip is a part of. `folder`: of the chip in sysfs; `up`: steps from its real
// place to that of the device.
std::string device_of(const fs::path& folder, int up) {
  std::error_code error;
  fs::path place = fs::canonical(folder, error);
  if (error)
    throw StartRefused(fmt::format("udev: {}: {}; expected the folder of a chip", folder.string(), error.message()));
  for (int i = 0; i < up; ++i) place = place.parent_path();
  return place.filename().string();
}

}  // namespace

std::string udev_rules(const machine::GpioSetup& setup, const std::string& chip, const fs::path& sys) {
  std::string text = fmt::format(
      "# Lines of \"{}\", of the machine file.\n"
      "SUBSYSTEM==\"gpio\", KERNEL==\"gpiochip*\", KERNELS==\"{}\", GROUP=\"stiction\", MODE=\"0660\"\n",
      setup.chip, device_of(sys / "bus/gpio/devices" / chip, 1));
  if (!setup.pwm_chip) return text;
  // A channel appears when it is exported, as a device of the chip.
  return text + fmt::format(
                    "# Duty of the power stage: channels appear when they are exported.\n"
                    "SUBSYSTEM==\"pwm\", KERNELS==\"{}\", ACTION!=\"remove\", RUN+=\"/bin/sh -c 'chgrp -R "
                    "stiction /sys%p && chmod -R g=u /sys%p'\"\n",
                    device_of(*setup.pwm_chip, 2));
}

}  // namespace stiction::drive
