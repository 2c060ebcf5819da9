// A machine's only axis as a power stage on Modbus (hal/modbus/power_stage.hpp), in the kernel's time: the other end of
// hal::ModbusBackend. It takes its stage off when the master's cycle stands still.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "hal/modbus/power_stage.hpp"
#include "hal/modbus/server.hpp"
#include "hal/snapshot.hpp"
#include "host/plant/plant_under_bus.hpp"

namespace stiction::host {

class ModbusSlave {
 public:
  // Without a new cycle of the master for so long the stage is off.
  static constexpr std::int64_t silence_ns = 200'000'000;

  // `address`: HOST:PORT, or a serial device. `period_ns`: of a tick of the plant. Throws hal::ModbusError.
  ModbusSlave(const std::string& address, std::int64_t period_ns, PlantUnderBus plant);

  // Serves until `stop` is true; it is asked each tick.
  void serve(const std::function<bool()>& stop);

  std::uint64_t ticks() const { return ticks_; }

 private:
  void take_writes(std::int64_t now_ns);
  void publish();

  std::int64_t period_ns_;
  PlantUnderBus plant_;
  hal::PowerStageCommand command_;
  std::int64_t heard_ns_ = 0;  // when the master's cycle last moved on
  bool enabled_ = false;
  std::uint64_t ticks_ = 0;
  hal::Snapshot<hal::PowerStageState> state_;
  hal::ModbusServer server_;  // last: its thread reads the state
};

}  // namespace stiction::host
