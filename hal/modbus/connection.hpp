// One client of a Modbus server over TCP: bytes in as they come, answers out as they are taken. No socket, so that a
// fuzzer can be the client.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/modbus/responder.hpp"

namespace stiction::hal {

class ModbusConnection {
 public:
  // `responder`: of all connections, must outlive this; `client`: the number of this one.
  explicit ModbusConnection(ModbusResponder& responder, std::uint16_t client = 1)
      : responder_(&responder), client_(client) {}

  // Answers every request that is whole now, also of those kept before; returns how many.
  int receive(std::span<const std::uint8_t> bytes);

  // What came was no request, and where the next one begins is not known: the connection is to be closed.
  bool is_lost() const { return lost_; }
  // Whether no more requests are taken: so much is unread, or the last one waits for what it asked for.
  bool is_full() const { return out_.size() > most_unread || is_waiting(); }
  // Whether a request was put off; resume() answers it once it is done, and then those that came behind it.
  bool is_waiting() const { return ticket_ != 0; }
  int resume();

  std::uint16_t client() const { return client_; }
  std::span<const std::uint8_t> unsent() const { return out_; }
  void sent(std::size_t bytes);

 private:
  static constexpr std::size_t most_unread = 16 * longest_modbus_request;

  ModbusResponder* responder_;
  std::uint16_t client_;
  std::vector<std::uint8_t> in_, out_;
  std::vector<std::uint8_t> waiting_;  // the request that was put off
  std::uint64_t ticket_ = 0;
  bool lost_ = false;
};

}  // namespace stiction::hal
