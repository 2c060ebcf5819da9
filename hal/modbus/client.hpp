// The drive as a Modbus master of slow power stages (power_stage.hpp), over a serial line or TCP, at most about 150
// exchanges a second: for commissioning, not for a loop of 62.5 us. The exchanges run in a thread of their own; the
// control loop's side is wait-free. Stages are switched off when the loop gives no new command for three periods, and
// when the client ends.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hal/modbus/error.hpp"
#include "hal/modbus/power_stage.hpp"
#include "hal/snapshot.hpp"
#include "stiction/drive/faults.hpp"

namespace stiction::hal {

struct ModbusClientConfig {
  std::string device;  // a serial device for RTU at 8E1, or HOST:PORT for TCP
  int baud_rate = 115200;
  std::vector<int> units{1};  // one an axis
  double period = 10e-3;      // s, of one exchange with every unit
};

struct PowerStageFeedback {
  PowerStageState state;
  std::int64_t time_ns = 0;    // CLOCK_MONOTONIC, the middle of the exchange; 0: none yet
  Fault fault = Fault::none;   // frames_lost: no new state for three periods; as long as that lasts
  std::uint32_t failures = 0;  // exchanges without a new state since the start
};

class ModbusClient {
 public:
  // Connects, asks every unit who it is, and begins the exchange with all stages off. Throws ModbusError: no such
  // device or host, a silent slave, other registers than these.
  explicit ModbusClient(const ModbusClientConfig& config);
  ~ModbusClient();
  ModbusClient(const ModbusClient&) = delete;
  ModbusClient& operator=(const ModbusClient&) = delete;

  // One an axis; from one thread, as often as it likes. The counts of cycles are the client's own.
  void command(std::span<const PowerStageCommand> commands);
  // The newest of every axis; from one thread.
  std::span<const PowerStageFeedback> feedback() { return feedback_.latest(); }

  // Sends every unit the command to switch off at once, beside the exchange under way, whose answer may be lost by it;
  // the exchanges that follow say the same until the power cut is released (hal/power_cut.hpp). Async-signal-safe.
  void cut_power() noexcept;

  // What went wrong last, for the log: "/dev/ttyS0, unit 1: no answer within 8 ms"; empty: nothing yet. Takes a lock:
  // not for the loop.
  std::string last_error() const;

 private:
  class Line;

  void run();
  void exchange_all();
  void exchange(std::size_t axis, PowerStageCommand command);

  ModbusClientConfig config_;
  std::unique_ptr<Line> line_;
  Snapshot<std::vector<PowerStageCommand>> commands_;
  Snapshot<std::vector<PowerStageFeedback>> feedback_;
  std::vector<PowerStageFeedback> newest_;  // the thread's own
  std::vector<std::uint16_t> schemas_;      // of the units' registers
  std::vector<int> misses_;                 // exchanges in a row without a new state
  std::uint16_t cycle_ = 0;
  int stale_commands_ = 3;  // periods in a row without a new command
  mutable std::mutex error_mutex_;
  std::string last_error_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace stiction::hal
