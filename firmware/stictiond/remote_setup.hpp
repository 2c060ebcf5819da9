// What set-points from outside are built from: the machine file's limits and its [drive.can_server], checked before
// anything is opened.
#pragma once

#include <vector>

#include "firmware/stictiond/can_server.hpp"
#include "firmware/stictiond/configuration.hpp"
#include "hal/bus_budget.hpp"
#include "stiction/drive/remote_axis.hpp"

namespace stiction::drive {

// One an axis. Throws StartRefused where a period or a limit is beyond what the interpolation holds.
std::vector<RemoteAxisConfig> remote_axes(const DriveConfiguration& configuration);

// Throws StartRefused where the machine file does not say what the bus needs, or its two CAN buses contradict each
// other.
CanServerConfig can_server_config(const DriveConfiguration& configuration);

// The cyclic frames of the motion controller and of the answers to it.
std::vector<hal::CyclicFrame> can_server_frames(const DriveConfiguration& configuration);

// What its bus has to carry, with the nodes' frames where both are on one interface.
hal::BusBudget can_server_budget(const DriveConfiguration& configuration);

// Identifiers that are the controller's and its answers' where both share the interface of [drive.can]; else none.
std::vector<std::uint32_t> can_server_identifiers(const DriveConfiguration& configuration);

// All of the above that the machine file asks for. Throws StartRefused, BusBudgetError.
void check_remote(const DriveConfiguration& configuration);

}  // namespace stiction::drive
