#include "hal/modbus/responder.hpp"

#include <modbus/modbus.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace stiction::hal {
namespace {

constexpr std::size_t tcp_header = 7;  // transaction 2, protocol 2, length 2, unit 1
constexpr std::size_t rtu_header = 1, rtu_crc = 2;

std::size_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::size_t>(bytes[at]) << 8 | bytes[at + 1];
}

// Length of a request's PDU, by its function: fixed, or with a number of bytes at a place.
struct FunctionRow {
  std::uint8_t code;
  std::size_t fixed;
  std::size_t count_at;  // 0: none
};
constexpr std::array<FunctionRow, 6> functions{{
    {MODBUS_FC_READ_HOLDING_REGISTERS, 5, 0},
    {MODBUS_FC_READ_INPUT_REGISTERS, 5, 0},
    {MODBUS_FC_WRITE_SINGLE_REGISTER, 5, 0},
    {MODBUS_FC_WRITE_MULTIPLE_REGISTERS, 6, 5},
    {MODBUS_FC_REPORT_SLAVE_ID, 1, 0},
    {MODBUS_FC_WRITE_AND_READ_REGISTERS, 10, 9},
}};

const FunctionRow* row_of(std::uint8_t code) {
  const auto* row = std::find_if(functions.begin(), functions.end(), [&](const auto& f) { return f.code == code; });
  return row == functions.end() ? nullptr : row;
}

// None: more bytes are needed. Functions that are not known are taken as their code alone.
std::optional<std::size_t> pdu_length(std::span<const std::uint8_t> pdu) {
  if (pdu.empty()) return {};
  const FunctionRow* row = row_of(pdu[0]);
  if (row == nullptr) return 1;
  if (row->count_at == 0) return row->fixed;
  if (pdu.size() <= row->count_at) return {};
  return row->fixed + pdu[row->count_at];
}

static_assert(longest_modbus_request == MODBUS_MAX_ADU_LENGTH);

}  // namespace

// libmodbus sends its answer into one end of a pair of sockets; what it sent is read from the other.
struct ModbusResponder::Library {
  modbus_t* context = nullptr;
  modbus_mapping_t* mapping = nullptr;
  std::array<int, 2> ends{-1, -1};

  Library(ModbusTransport transport, const RegisterMap& map, int unit) {
    context = transport == ModbusTransport::tcp ? modbus_new_tcp("127.0.0.1", 502)
                                                : modbus_new_rtu("/dev/null", 115200, 'E', 8, 1);
    mapping = modbus_mapping_new(0, 0, static_cast<int>(map.size(RegisterTable::holding)),
                                 static_cast<int>(map.size(RegisterTable::input)));
    if (context == nullptr || mapping == nullptr ||
        ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      release();
      throw std::system_error(errno, std::generic_category(), "Modbus responder");
    }
    modbus_set_slave(context, unit);
    modbus_set_socket(context, ends[0]);
    // It sleeps for this long after some malformed requests; nothing is to be flushed here.
    modbus_set_response_timeout(context, 0, 1);
  }
  ~Library() { release(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  std::vector<std::uint8_t> sent() const {
    std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> bytes;
    const ssize_t got = ::recv(ends[1], bytes.data(), bytes.size(), MSG_DONTWAIT);
    return got > 0 ? std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + got) : std::vector<std::uint8_t>{};
  }

 private:
  void release() {
    for (const int end : ends)
      if (end >= 0) ::close(end);
    if (mapping != nullptr) modbus_mapping_free(mapping);
    if (context != nullptr) modbus_free(context);
  }
};

ModbusResponder::ModbusResponder(ModbusTransport transport, const RegisterMap& map, RegisterValues values,
                                 bool motion_allowed, int unit, WriteTaker& taker)
    : transport_(transport),
      map_(map),
      refresh_(std::move(values)),
      motion_allowed_(motion_allowed),
      unit_(unit),
      taker_(taker),
      values_(map.registers().size()),
      library_(std::make_unique<Library>(transport, map, unit)) {}

ModbusResponder::~ModbusResponder() = default;

std::vector<std::uint8_t> ModbusResponder::answer(std::span<const std::uint8_t> request, std::uint16_t client) {
  const bool tcp = transport_ == ModbusTransport::tcp;
  const std::size_t header = tcp ? tcp_header : rtu_header;
  const std::size_t end = request.size() - (tcp ? 0 : rtu_crc);
  if (request.size() <= header + (tcp ? 0 : rtu_crc) || request.size() > MODBUS_MAX_ADU_LENGTH) return {};
  if (!tcp) {
    const std::uint16_t crc = modbus_crc(request.first(end));
    if (request[end] != (crc & 0xff) || request[end + 1] != crc >> 8) return {};
    if (request[0] != unit_) return {};  // nor broadcasts: they cannot be refused
  }
  put_off_ = 0;
  taker_.begin_request(client);
  const auto refusal = refusal_of(request.subspan(header, end - header));
  if (put_off_ != 0) return {};
  return reply(request, refusal);
}

std::optional<std::vector<std::uint8_t>> ModbusResponder::late_answer(std::span<const std::uint8_t> request,
                                                                      std::uint64_t ticket, std::uint16_t client) {
  taker_.begin_request(client);
  const auto verdict = taker_.outcome(ticket);
  if (!verdict) return {};
  return reply(request, verdict->refused);
}

std::vector<std::uint8_t> ModbusResponder::reply(std::span<const std::uint8_t> request,
                                                 std::optional<ModbusException> refusal) {
  // libmodbus takes a buffer of the longest request, whatever the length that it is told.
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> bytes{};
  std::copy(request.begin(), request.end(), bytes.begin());
  if (refusal) {
    modbus_reply_exception(library_->context, bytes.data(), static_cast<unsigned>(*refusal));
    return library_->sent();
  }
  refresh_(values_);
  modbus_mapping_t& mapping = *library_->mapping;
  map_.encode(values_, {mapping.tab_input_registers, map_.size(RegisterTable::input)},
              {mapping.tab_registers, map_.size(RegisterTable::holding)});
  modbus_reply(library_->context, bytes.data(), static_cast<int>(request.size()), &mapping);
  return library_->sent();
}

// What libmodbus does not look at: the request's length, and who may write what.
std::optional<ModbusException> ModbusResponder::refusal_of(std::span<const std::uint8_t> pdu) {
  if (row_of(pdu[0]) == nullptr) return ModbusException::illegal_function;
  if (pdu_length(pdu) != pdu.size()) return ModbusException::illegal_value;
  switch (pdu[0]) {
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return take_writes(word_at(pdu, 1), pdu.subspan(3, 2));
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      if (word_at(pdu, 3) == 0 || word_at(pdu, 3) * 2 != pdu.size() - 6) return ModbusException::illegal_value;
      return take_writes(word_at(pdu, 1), pdu.subspan(6));
    case MODBUS_FC_WRITE_AND_READ_REGISTERS: {
      const std::size_t read = word_at(pdu, 3);
      if (read == 0 || read > MODBUS_MAX_WR_READ_REGISTERS) return ModbusException::illegal_value;
      if (word_at(pdu, 7) == 0 || word_at(pdu, 7) * 2 != pdu.size() - 10) return ModbusException::illegal_value;
      // Nothing is written where reading would be refused.
      if (word_at(pdu, 1) + read > map_.size(RegisterTable::holding)) return ModbusException::illegal_address;
      return take_writes(word_at(pdu, 5), pdu.subspan(10));
    }
    default:
      return {};
  }
}

std::optional<ModbusException> ModbusResponder::take_writes(std::size_t address, std::span<const std::uint8_t> bytes) {
  std::vector<std::uint16_t> words;
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2)
    words.push_back(static_cast<std::uint16_t>(word_at(bytes, at)));
  const auto writes = map_.writes_of(address, words, motion_allowed_);
  if (const auto* exception = std::get_if<ModbusException>(&writes)) return *exception;
  const WriteVerdict verdict = taker_.take(std::get<std::vector<RegisterWrite>>(writes));
  put_off_ = verdict.put_off;
  return verdict.refused;
}

std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint16_t>((crc & 1) != 0 ? (crc >> 1) ^ 0xa001 : crc >> 1);
  }
  return crc;
}

}  // namespace stiction::hal
