#include "hal/modbus/serial_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "hal/modbus/error.hpp"

namespace stiction::hal {
namespace {

// libmodbus takes 9600 in silence for every other one.
constexpr std::array<int, 15> rates{1200,   2400,   4800,   9600,   19200,  38400,   57600, 115200,
                                    230400, 460800, 500000, 576000, 921600, 1000000, 0};

const char* advice_for(int error) {
  switch (error) {
    case ENOENT:
      return "is it plugged in, and is the name right?";
    case EACCES:
      return "add the user to the group of the device (dialout)";
    case EBUSY:
      return "it is in use by a different programme";
    default:
      return "is it a serial line?";
  }
}

}  // namespace

ModbusContext open_serial_line(const std::string& device, int baud_rate, int unit) {
  if (std::find(rates.begin(), rates.end() - 1, baud_rate) == rates.end() - 1)
    throw ModbusError(fmt::format("{}: found a rate of {} bit/s; expected a rate of serial lines, such as 115200",
                                  device, baud_rate));
  ModbusContext context(modbus_new_rtu(device.c_str(), baud_rate, 'E', 8, 1));
  if (!context || modbus_set_slave(context.get(), unit) != 0 || modbus_connect(context.get()) != 0)
    throw ModbusError(fmt::format("{}: cannot be opened: {}; {}", device, std::strerror(errno), advice_for(errno)));
  return context;
}

HostAndPort host_and_port(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  HostAndPort found;
  if (colon != std::string::npos) {
    found = {address.substr(0, colon), address.substr(colon + 1)};
    if (found.host.size() > 1 && found.host.front() == '[' && found.host.back() == ']')
      found.host = found.host.substr(1, found.host.size() - 2);
  }
  const bool digits =
      !found.port.empty() && found.port.size() <= 5 && found.port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::atoi(found.port.c_str()) > 65535 || found.host.empty())
    throw ModbusError(fmt::format("found \"{}\"; expected HOST:PORT, such as 127.0.0.1:502", address));
  return found;
}

}  // namespace stiction::hal
