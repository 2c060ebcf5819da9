// The request by which a power stage is switched off, made before it is needed: a signal handler sends it as it is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/modbus/power_stage.hpp"
#include "hal/modbus/responder.hpp"

namespace stiction::hal {

using OffRequest = std::vector<std::uint8_t>;

// Function 16: all registers of the command are 0. `unit`: of the stage; `transport`: its framing.
inline OffRequest off_request(int unit, ModbusTransport transport) {
  constexpr std::uint8_t write_registers = 16, words = power_stage_written_words;
  std::array<std::uint16_t, words> command{};
  put_words({}, command);
  OffRequest request{static_cast<std::uint8_t>(unit),
                     write_registers,
                     power_stage_written >> 8,
                     power_stage_written & 0xff,
                     0,
                     words,
                     2 * words};
  for (const std::uint16_t word : command) {
    request.push_back(static_cast<std::uint8_t>(word >> 8));
    request.push_back(static_cast<std::uint8_t>(word & 0xff));
  }
  if (transport == ModbusTransport::tcp) {
    constexpr std::uint8_t of_nobody = 0xff;  // transaction of no exchange
    const std::array<std::uint8_t, 6> header{of_nobody, of_nobody, 0, 0, 0, static_cast<std::uint8_t>(request.size())};
    request.insert(request.begin(), header.begin(), header.end());
  } else {
    const std::uint16_t crc = modbus_crc(request);
    request.push_back(static_cast<std::uint8_t>(crc & 0xff));
    request.push_back(static_cast<std::uint8_t>(crc >> 8));
  }
  return request;
}

}  // namespace stiction::hal
