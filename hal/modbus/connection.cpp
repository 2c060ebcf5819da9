#include "hal/modbus/connection.hpp"

#include <algorithm>
#include <optional>

namespace stiction::hal {
namespace {

// Before the unit and the PDU: transaction 2 bytes, protocol 2, length of what follows 2.
constexpr std::size_t length_end = 6;

std::size_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::size_t>(bytes[at]) << 8 | bytes[at + 1];
}

bool cannot_begin_request(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= 4 && word_at(bytes, 2) != 0) return true;  // not the protocol Modbus
  if (bytes.size() < length_end) return false;
  const std::size_t length = word_at(bytes, 4);
  return length < 2 || length_end + length > longest_modbus_request;
}

std::optional<std::size_t> length_of_request(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < length_end) return {};
  return length_end + word_at(bytes, 4);
}

}  // namespace

int ModbusConnection::receive(std::span<const std::uint8_t> bytes) {
  in_.insert(in_.end(), bytes.begin(), bytes.end());
  int answered = 0;
  std::span<const std::uint8_t> rest = in_;
  while (!rest.empty() && !is_full()) {
    if (cannot_begin_request(rest)) {
      lost_ = true;
      rest = {};
      break;
    }
    const auto length = length_of_request(rest);
    if (!length || *length > rest.size()) break;
    const auto answer = responder_->answer(rest.first(*length), client_);
    out_.insert(out_.end(), answer.begin(), answer.end());
    ticket_ = responder_->put_off();
    if (is_waiting()) waiting_.assign(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(*length));
    rest = rest.subspan(*length);
    ++answered;
  }
  in_.erase(in_.begin(), in_.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return answered;
}

int ModbusConnection::resume() {
  if (!is_waiting()) return 0;
  const auto answer = responder_->late_answer(waiting_, ticket_, client_);
  if (!answer) return 0;
  ticket_ = 0;
  out_.insert(out_.end(), answer->begin(), answer->end());
  return 1 + receive({});
}

void ModbusConnection::sent(std::size_t bytes) {
  out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(std::min(bytes, out_.size())));
}

}  // namespace stiction::hal
