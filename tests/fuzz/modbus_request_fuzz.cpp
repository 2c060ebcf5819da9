// Any bytes from a Modbus client, in pieces as they may come: over TCP through a connection of the server, over RTU as
// one frame with its checksum made right. The first byte chooses; answers keep to their framing and nothing is taken
// that the register map does not allow.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "hal/modbus/connection.hpp"

namespace {

using namespace stiction;

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

hal::Register made(hal::RegisterTable table, int address, hal::RegisterType type, hal::RegisterAccess access) {
  hal::Register r;
  r.table = table;
  r.address = static_cast<std::uint16_t>(address);
  r.type = type;
  r.access = access;
  r.name = "register";
  r.low = -100.0;
  r.high = 100.0;
  return r;
}

const hal::RegisterMap& map() {
  using enum hal::RegisterTable;
  using enum hal::RegisterType;
  using enum hal::RegisterAccess;
  static const hal::RegisterMap map({made(input, 0, uint16, read), made(input, 2, int32, read),
                                     made(holding, 0, uint16, write), made(holding, 1, float32, write),
                                     made(holding, 3, int16, read), made(holding, 4, uint16, motion),
                                     made(holding, 8, int32, write)});
  return map;
}

void values(std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
}

void check_writes(hal::WriteQueue& queue, bool motion_allowed) {
  while (const auto write = queue.take()) {
    require(write->index < map().registers().size(), "a write to no register");
    const auto& r = map().registers()[write->index];
    require(r.access != hal::RegisterAccess::read, "a write to a register that is only read");
    require(motion_allowed || r.access != hal::RegisterAccess::motion, "motion without permission");
    require(write->value >= r.low && write->value <= r.high, "a value out of range");
  }
}

void as_tcp(std::span<const std::uint8_t> bytes, std::size_t piece, bool motion_allowed) {
  hal::WriteQueue queue;
  hal::QueueTaker taker(queue);
  hal::ModbusResponder responder(hal::ModbusTransport::tcp, map(), values, motion_allowed, 1, taker);
  hal::ModbusConnection connection(responder);
  std::vector<std::uint8_t> out;
  while (!bytes.empty() && !connection.is_lost()) {
    const std::size_t next = std::min(piece, bytes.size());
    connection.receive(bytes.first(next));
    bytes = bytes.subspan(next);
    require(connection.unsent().size() <= 17 * hal::longest_modbus_request, "unsent answers without a bound");
    out.insert(out.end(), connection.unsent().begin(), connection.unsent().end());
    connection.sent(connection.unsent().size());
    check_writes(queue, motion_allowed);
  }
  // Whole frames of the protocol, one after the other.
  std::span<const std::uint8_t> rest = out;
  while (!rest.empty()) {
    require(rest.size() >= 9, "an answer cut short");
    const std::size_t length = 6 + (static_cast<std::size_t>(rest[4]) << 8 | rest[5]);
    require(
        rest[2] == 0 && rest[3] == 0 && length >= 9 && length <= rest.size() && length <= hal::longest_modbus_request,
        "an answer that is no frame");
    rest = rest.subspan(length);
  }
}

void as_rtu(std::span<const std::uint8_t> bytes, bool motion_allowed) {
  hal::WriteQueue queue;
  hal::QueueTaker taker(queue);
  hal::ModbusResponder responder(hal::ModbusTransport::rtu, map(), values, motion_allowed, 1, taker);
  std::vector<std::uint8_t> frame(
      bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(bytes.size(), 300)));
  responder.answer(frame);  // as it came
  if (frame.empty()) return;
  frame[0] = 1;
  const std::uint16_t crc = hal::modbus_crc(frame);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xff));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  const auto answer = responder.answer(frame);
  check_writes(queue, motion_allowed);
  if (answer.empty()) return;
  const std::uint16_t sum = hal::modbus_crc(std::span(answer).first(answer.size() - 2));
  require(
      answer.size() >= 5 && answer[0] == 1 && answer[answer.size() - 2] == (sum & 0xff) && answer.back() == sum >> 8,
      "an answer that is no frame");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span bytes(data + 1, size - 1);
  const bool motion_allowed = (data[0] & 1) != 0;
  if ((data[0] & 2) != 0)
    as_rtu(bytes, motion_allowed);
  else
    as_tcp(bytes, std::size_t{1} + (data[0] >> 2), motion_allowed);
  return 0;
}
