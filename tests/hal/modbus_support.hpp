// What the Modbus tests share: a small register map, independent peers, a serial line without wires.
#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hal/modbus/server.hpp"

namespace stiction::test {

// Waits for what another thread or process must do; half a minute is far more than a busy machine needs.
template <class Condition>
bool comes_true(Condition condition) {
  for (int tries = 0; tries < 6000; ++tries) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

// All that a command printed.
inline std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "popen failed";
  std::array<char, 256> line;
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) output += line.data();
  ::pclose(pipe);
  return output;
}

inline bool has_mbpoll() { return !output_of("command -v mbpoll").empty(); }
inline bool has_pymodbus() {
  return output_of("/usr/bin/python3 -c 'import pymodbus, serial_asyncio; print(1)'") == "1\n";
}
inline std::string pymodbus(const std::string& arguments) {
  return "exec /usr/bin/python3 " STICTION_SOURCE_DIR "/tests/hal/modbus_peer.py " + arguments;
}

// A program that runs until the end of the scope.
class Process {
 public:
  explicit Process(const std::string& command) : child_(::fork()) {
    if (child_ == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
  }
  ~Process() { stop(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  void stop() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = 0;
  }

 private:
  pid_t child_;
};

// Two serial devices, each the other's far end.
class SerialPair {
 public:
  SerialPair() {
    for (int end = 0; end < 2; ++end) {
      std::array<char, 128> name{};
      int slave = -1;
      if (::openpty(&master_[end], &slave, name.data(), nullptr, nullptr) != 0) throw std::runtime_error("openpty");
      // Stays open, so that the line lives on when a program closes it.
      kept_[end] = slave;
      names_[end] = name.data();
      // Raw from the start: no echo before the first program sets it up.
      termios settings{};
      ::tcgetattr(slave, &settings);
      ::cfmakeraw(&settings);
      ::tcsetattr(slave, TCSANOW, &settings);
    }
    thread_ = std::thread([this] { carry(); });
  }
  ~SerialPair() {
    stop_ = true;
    thread_.join();
    for (int end = 0; end < 2; ++end) {
      ::close(master_[end]);
      ::close(kept_[end]);
    }
  }
  SerialPair(const SerialPair&) = delete;
  SerialPair& operator=(const SerialPair&) = delete;

  const std::string& name(int end) const { return names_[end]; }

 private:
  void carry() {
    while (!stop_) {
      std::array<pollfd, 2> polled{{{master_[0], POLLIN, 0}, {master_[1], POLLIN, 0}}};
      if (::poll(polled.data(), 2, 20) <= 0) continue;
      for (int end = 0; end < 2; ++end) {
        std::array<char, 512> bytes;
        if ((polled[end].revents & POLLIN) == 0) continue;
        const ssize_t got = ::read(master_[end], bytes.data(), bytes.size());
        if (got > 0 && ::write(master_[1 - end], bytes.data(), static_cast<std::size_t>(got)) != got) return;
      }
    }
  }

  std::array<int, 2> master_{}, kept_{};
  std::array<std::string, 2> names_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// A plain connection, for what no well-behaved client sends.
class RawClient {
 public:
  explicit RawClient(int port) : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~RawClient() { ::close(descriptor_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }
  int descriptor() const { return descriptor_; }
  void send(const std::vector<std::uint8_t>& bytes) const {
    [[maybe_unused]] const auto sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  // Empty: the server closed the connection.
  std::vector<std::uint8_t> receive() const {
    std::vector<std::uint8_t> bytes(300);
    const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return bytes;
  }

 private:
  int descriptor_;
  bool connected_ = false;
};

inline std::vector<std::uint8_t> request(std::vector<std::uint8_t> pdu) {
  std::vector<std::uint8_t> bytes{0, 7, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 1};
  bytes.insert(bytes.end(), pdu.begin(), pdu.end());
  return bytes;
}

// Values 1, 2, 3, ... of five registers, of which two are for writing and one moves an axis.
inline std::vector<hal::Register> small_registers() {
  using enum hal::RegisterTable;
  using enum hal::RegisterType;
  using enum hal::RegisterAccess;
  const auto made = [](hal::RegisterTable table, int address, hal::RegisterType type, hal::RegisterAccess access,
                       const char* name) {
    hal::Register r;
    r.table = table;
    r.address = static_cast<std::uint16_t>(address);
    r.type = type;
    r.access = access;
    r.name = name;
    r.unit = "1";
    return r;
  };
  std::vector<hal::Register> registers{
      made(input, 0, uint16, read, "state"),      made(input, 2, int32, read, "position"),
      made(holding, 0, uint16, write, "mode"),    made(holding, 10, float32, write, "gain"),
      made(holding, 20, uint16, motion, "start"),
  };
  registers[1].scale = 1e-8;
  registers[3].low = 0.0;
  registers[3].high = 100.0;
  registers[3].low_open = true;
  return registers;
}

inline void small_values(std::span<double> values) {
  values[0] = 1.0;
  values[1] = -0.123456789;  // -12345679 steps: FF43 9EB1h
  values[2] = 3.0;
  values[3] = 6.25;  // 40C8 0000h
  values[4] = 0.0;
}

}  // namespace stiction::test
