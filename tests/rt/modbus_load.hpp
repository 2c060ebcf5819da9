// Clients of a Modbus server on this computer, without a library: one request at a time each.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace stiction::test {

class ModbusConnection {
 public:
  explicit ModbusConnection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  }
  ~ModbusConnection() { ::close(socket_); }
  ModbusConnection(ModbusConnection&& other) noexcept
      : socket_(other.socket_), connected_(other.connected_), waits_(other.waits_) {
    other.socket_ = -1;
  }
  ModbusConnection(const ModbusConnection&) = delete;
  ModbusConnection& operator=(const ModbusConnection&) = delete;
  ModbusConnection& operator=(ModbusConnection&&) = delete;

  bool connected() const { return connected_; }

  // A parameter of two registers.
  void write(std::uint16_t address, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    send({0x10, byte(address, 1), byte(address, 0), 0, 2, 4, byte(bits, 3), byte(bits, 2), byte(bits, 1),
          byte(bits, 0)});
  }
  void write_register(std::uint16_t address, std::uint16_t value) {
    send({0x06, byte(address, 1), byte(address, 0), byte(value, 1), byte(value, 0)});
  }

  // Whether the last request has been answered, a refusal included. Reads what is there and does not wait.
  bool idle() {
    std::array<std::uint8_t, 64> answer{};
    if (::recv(socket_, answer.data(), answer.size(), 0) > 0) waits_ = false;
    return !waits_;
  }

 private:
  static std::uint8_t byte(std::uint32_t word, int place) { return static_cast<std::uint8_t>(word >> 8 * place); }
  void send(const std::vector<std::uint8_t>& pdu) {
    std::vector<std::uint8_t> request{0, 1, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 1};
    request.insert(request.end(), pdu.begin(), pdu.end());
    waits_ = ::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) > 0;
  }

  int socket_;
  bool connected_ = false;
  bool waits_ = false;
};

}  // namespace stiction::test
