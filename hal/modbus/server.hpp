// A Modbus slave that publishes a register map to a PLC or an operator panel, over TCP to many clients or over a serial
// line. Runs in a thread of its own, by poll(); the control loop meets it only through what `values` reads
// (snapshot.hpp) and through take_write(), which are wait-free. No client can stop it: bytes are taken as they come, an
// answer that is not read is kept up to a bound and its client is then not listened to, and what is no request closes
// the connection.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "hal/modbus/error.hpp"
#include "hal/modbus/responder.hpp"

namespace stiction::hal {

struct ModbusServerConfig {
  std::string address;          // "HOST:PORT" to listen on, port 0: any free one; or a serial device for RTU
  bool motion_allowed = false;  // whether registers that move an axis are taken
  int unit = 1;                 // on RTU
  int baud_rate = 115200;       // of RTU, 8E1
  int most_clients = 32;        // a further one is turned away: a master is not thrown out by who comes later
};

struct ModbusServerCounts {
  std::uint64_t requests = 0;
  std::uint64_t connections = 0;
  std::uint64_t dropped = 0;  // connections closed here or turned away, and on RTU bytes that made no request
};

class ModbusServer {
 public:
  // Listens when this returns. `values` is called in the server's thread. Throws ModbusError. `map`: the registers;
  // `config`: address, unit and whether motion is allowed; `taker`: what clients write goes there, in the server's
  // thread, and must outlive this; null: to take_write().
  ModbusServer(RegisterMap map, const ModbusServerConfig& config, RegisterValues values, WriteTaker* taker = nullptr);
  ~ModbusServer();
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  // What clients wrote, oldest first; for one thread. Wait-free.
  std::optional<RegisterWrite> take_write() { return queue_.take(); }
  const RegisterMap& map() const { return map_; }
  int port() const { return port_; }  // of TCP
  ModbusServerCounts counts() const;

 private:
  class Endpoint;
  class TcpEndpoint;
  class SerialEndpoint;

  RegisterMap map_;
  WriteQueue queue_;
  QueueTaker queue_taker_{queue_};
  WriteTaker* taker_;
  int port_ = 0;
  std::atomic<std::uint64_t> requests_{0}, connections_{0}, dropped_{0};
  int stop_ = -1;  // eventfd
  std::unique_ptr<Endpoint> endpoint_;
  std::thread thread_;
};

}  // namespace stiction::hal
