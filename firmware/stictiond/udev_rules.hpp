// Rules for udev that give the drive's group the chips of one machine file, and no others of the computer.
#pragma once

#include <filesystem>
#include <string>

#include "firmware/machine/model/drive_setup.hpp"

namespace stiction::drive {

// A rule for the gpiochip and one for the PWM chip, where the machine has one. They name the device that the chip is a
// part of, as the number of a gpiochip changes from start to start. The kernel gives chips, not single lines. `setup`:
// of the machine file; `chip`: the kernel's name of its gpiochip, such as gpiochip0; `sys`: the root of sysfs. Throws
// StartRefused where one of them is not there.
std::string udev_rules(const machine::GpioSetup& setup, const std::string& chip, const std::filesystem::path& sys);

}  // namespace stiction::drive
