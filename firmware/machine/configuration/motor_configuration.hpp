// What a machine file says about a motor and its power stage, as the drive's configuration has it.
#pragma once

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "stiction/drive/servo_drive_config.hpp"

namespace stiction::machine {

// Of a body that bears `current` (A) for ever and has a `time_constant` (s), for steps of `step` (s).
ThermalModel::Config thermal_model(double current, double time_constant, double step);

// Fills commutation, brake test and protection of `config`. `timing`: the drive's periods; `axis`: the motor's
// constants, but for its true commutation offset, which is the plant's; `setup`: what the drive is told. Throws
// ConfigurationError.
template <class S>
void configure_motor(const Timing& timing, const AxisModel& axis, const DriveAxisSetup& setup,
                     ServoDriveConfig<S>& config);

}  // namespace stiction::machine
