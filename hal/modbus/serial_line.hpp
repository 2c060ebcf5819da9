// A serial line as libmodbus sets it up, and the names of devices as messages and configurations have them.
#pragma once

#include <modbus/modbus.h>

#include <memory>
#include <string>

namespace stiction::hal {

struct ModbusContextDeleter {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using ModbusContext = std::unique_ptr<modbus_t, ModbusContextDeleter>;

// An open serial line at 8E1. Throws ModbusError that says what to do: no such device, no right, a rate that the line
// does not have. `device`: path; `baud_rate`: bit/s; `unit`: slave that is addressed, 1 to 247.
ModbusContext open_serial_line(const std::string& device, int baud_rate, int unit);

struct HostAndPort {
  std::string host, port;
};
// Of "HOST:PORT", "[::1]:502" too. Throws ModbusError.
HostAndPort host_and_port(const std::string& address);

}  // namespace stiction::hal
