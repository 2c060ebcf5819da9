// From the machine file's [drive] to what the GPIO backend is told.
#pragma once

#include <vector>

#include "hal/gpio/config.hpp"
#include "sim/model/drive_setup.hpp"
#include "sim/model/machine.hpp"

namespace stiction::drive {

hal::Bias input_bias(const sim::DriveSetup& setup);

// Enable, brake, fault and switches of every axis, in the machine's order.
std::vector<hal::AxisLines> gpio_lines(const sim::DriveSetup& setup, const sim::Machine& machine);

// Whether any of them is wired to the chip of [drive.gpio].
bool has_gpio_lines(const sim::DriveSetup& setup, const sim::Machine& machine);

// A machine on GPIO alone. Throws hal::GpioError where [drive.gpio] is missing, or where an axis has current
// controllers: GPIO carries no current.
hal::GpioBackendConfig gpio_configuration(const sim::DriveSetup& setup, const sim::Machine& machine);

}  // namespace stiction::drive
