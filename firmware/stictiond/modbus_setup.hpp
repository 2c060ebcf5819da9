// What a machine file says of Modbus, as the client and the server of hal/modbus take it.
#pragma once

#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "hal/bus_budget.hpp"
#include "hal/modbus/client.hpp"
#include "hal/modbus/server.hpp"

namespace stiction::drive {

// Of [drive.modbus_server], which must be there.
hal::ModbusServerConfig modbus_server_config(const machine::DriveSetup& setup);

// Of [drive.modbus_client], which must be there: the unit of an axis is its drive.axis.NAME.node, that of a single axis
// without one the client's own. Throws hal::ModbusError where an axis has none or two have the same.
hal::ModbusClientConfig modbus_client_config(const machine::Machine& machine, const machine::DriveSetup& setup);

// What the client's exchanges take of their line; for hal::check() and hal::budget_table().
hal::BusBudget modbus_client_budget(const hal::ModbusClientConfig& config);

}  // namespace stiction::drive
