// From the machine file's [drive] to what the GPIO backend is told.
#pragma once

#include <vector>

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "hal/gpio/config.hpp"

namespace stiction::drive {

hal::Bias input_bias(const machine::DriveSetup& setup);

// The pulse for a watchdog outside of the computer. `setup`: of the machine file.
hal::WatchdogConfig watchdog_config(const machine::DriveSetup& setup);

// Enable, brake, fault and switches of every axis, in the machine's order.
std::vector<hal::AxisLines> gpio_lines(const machine::DriveSetup& setup, const machine::Machine& machine);

// Of the cam switch, one a track. `setup`: of the machine file.
std::vector<hal::LineConfig> track_lines(const machine::DriveSetup& setup);

// Whether any of these, or the pulse for a watchdog, is wired to the chip of [drive.gpio].
bool has_gpio_lines(const machine::DriveSetup& setup, const machine::Machine& machine);

// A machine on GPIO alone. Throws hal::GpioError where [drive.gpio] is missing, or where an axis has current
// controllers: GPIO carries no current. `setup`, `machine`: of the
// machine file; `takes_over`: PWM channels that run are what a run that was killed left.
hal::GpioBackendConfig gpio_configuration(const machine::DriveSetup& setup, const machine::Machine& machine,
                                          bool takes_over = false);

}  // namespace stiction::drive
