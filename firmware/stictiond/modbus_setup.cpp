#include "firmware/stictiond/modbus_setup.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stiction::drive {

hal::ModbusServerConfig modbus_server_config(const machine::DriveSetup& setup) {
  const machine::ModbusServerSetup& server = setup.modbus_server.value();
  hal::ModbusServerConfig config;
  config.address = server.address;
  config.motion_allowed = server.motion_allowed;
  config.unit = server.unit;
  config.baud_rate = server.baud_rate;
  return config;
}

hal::ModbusClientConfig modbus_client_config(const machine::Machine& machine, const machine::DriveSetup& setup) {
  const machine::ModbusClientSetup& client = setup.modbus_client.value();
  hal::ModbusClientConfig config{client.device, client.baud_rate, {}, client.period};
  for (const machine::AxisModel& axis : machine.axes) {
    int unit = setup.axes.at(axis.name).node;
    if (unit == 0 && machine.axes.size() == 1) unit = client.unit;
    if (unit == 0)
      throw hal::ModbusError(fmt::format("drive.axis.{}.node: found 0; expected the unit of its power stage on {}",
                                         axis.name, client.device));
    if (std::find(config.units.begin(), config.units.end(), unit) != config.units.end())
      throw hal::ModbusError(
          fmt::format("drive.axis.{}.node: found {} a second time; expected a unit of its own", axis.name, unit));
    config.units.push_back(unit);
  }
  return config;
}

hal::BusBudget modbus_client_budget(const hal::ModbusClientConfig& config) {
  return hal::modbus_budget(config.device, config.baud_rate,
                            {{"power stage", hal::power_stage_written_words, hal::power_stage_read_words,
                              static_cast<int>(config.units.size()), config.period}});
}

}  // namespace stiction::drive
