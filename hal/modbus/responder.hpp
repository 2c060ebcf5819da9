// Answers one request of a Modbus client after the other: bytes in, bytes out, no socket. Lengths and rights are
// checked here; libmodbus makes the answers. Protocol: Modbus application protocol V1.1b3, functions 3, 4, 6, 16, 17
// and 23.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/modbus/register_map.hpp"
#include "hal/modbus/write_taker.hpp"

namespace stiction::hal {

// Longest request with its framing.
inline constexpr std::size_t longest_modbus_request = 260;

enum class ModbusTransport : std::uint8_t { tcp, rtu };

// Writes one value for each register of the map, in their order.
using RegisterValues = std::function<void(std::span<double>)>;

class ModbusResponder {
 public:
  // `unit`: that this slave has on RTU; over TCP every unit is answered. `taker` takes what clients write and must
  // outlive this. `transport`: RTU or TCP; `map`: the registers, must outlive this; `values`: asked for each answer;
  // `motion_allowed`: registers that move an axis may be written.
  ModbusResponder(ModbusTransport transport, const RegisterMap& map, RegisterValues values, bool motion_allowed,
                  int unit, WriteTaker& taker);
  ~ModbusResponder();
  ModbusResponder(const ModbusResponder&) = delete;
  ModbusResponder& operator=(const ModbusResponder&) = delete;

  // The answer to one whole request, framing and all; empty where a slave is silent (RTU: damaged, or for another
  // unit). `client`: number of the connection that it came over.
  std::vector<std::uint8_t> answer(std::span<const std::uint8_t> request, std::uint16_t client = 1);
  // The ticket by which the last answer() put its request off and gave no answer; 0: it did not.
  std::uint64_t put_off() const { return put_off_; }
  // The answer to a request that was put off; none: what it asked for is not done. `request`, `ticket`, `client`: as
  // they were.
  std::optional<std::vector<std::uint8_t>> late_answer(std::span<const std::uint8_t> request, std::uint64_t ticket,
                                                       std::uint16_t client = 1);

 private:
  struct Library;  // libmodbus' context and mapping

  std::vector<std::uint8_t> reply(std::span<const std::uint8_t> request, std::optional<ModbusException> refusal);
  std::optional<ModbusException> refusal_of(std::span<const std::uint8_t> pdu);
  std::optional<ModbusException> take_writes(std::size_t address, std::span<const std::uint8_t> bytes);

  ModbusTransport transport_;
  const RegisterMap& map_;
  RegisterValues refresh_;
  bool motion_allowed_;
  int unit_;
  WriteTaker& taker_;
  std::uint64_t put_off_ = 0;
  std::vector<double> values_;
  std::unique_ptr<Library> library_;
};

// CRC of Modbus RTU over `bytes`, polynomial A001h, low byte first on the wire.
std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes);

}  // namespace stiction::hal
