// From the machine file's [drive] to the configuration of the firmware's drives.
#pragma once

#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "firmware/machine/model/drive_setup.hpp"
#include "stiction/drive/servo_drive.hpp"

namespace stiction::machine {

// `setup` with its optional values filled in, as read_drive_setup() gives it. S: FixedSignals or DoubleSignals. Throws
// ConfigurationError. Whether limit switches are wired is told by their lines; a backend that reads them from
// elsewhere sets supervision.negative_switch and positive_switch.
template <class S>
// `timing` and `axis`: of the machine file.
ServoDriveConfig<S> configure_drive(const Timing& timing, const AxisModel& axis, const DriveAxisSetup& setup);

// Of all axes.
template <class S>
std::vector<ServoDriveConfig<S>> configure_drives(const Machine& machine, const DriveSetup& setup);

}  // namespace stiction::machine
