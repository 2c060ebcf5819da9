// Axes whose power stages and encoders are Modbus slaves (power_stage.hpp): for a loop of 10 ms and commissioning, not
// for 62.5 us. There is one voltage an axis, the first: it suits stages that take a voltage as it is (motor models
// "force" and "dc"). The loop reads what came last; it never waits for the bus.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "hal/modbus/client.hpp"
#include "hal/tick_clock.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::hal {

class ModbusBackend {
 public:
  using Signals = FixedSignals;

  // `clock` gives the ticks; both must outlive this.
  ModbusBackend(ModbusClient& client, TickClock& clock)
      : client_(client), clock_(clock), commands_(client.feedback().size()) {
    const auto first = client_.feedback();
    newest_.assign(first.begin(), first.end());
  }

  std::size_t axis_count() const { return commands_.size(); }

  void begin() { clock_.restart(); }

  std::int64_t wait_for_tick() { return now_ns_ = clock_.wait(); }

  void read(std::span<Feedback<Signals>> feedback) {
    const auto seen = client_.feedback();
    std::copy(seen.begin(), seen.end(), newest_.begin());
    for (std::size_t i = 0; i < newest_.size(); ++i) {
      const PowerStageState& state = newest_[i].state;
      Feedback<Signals>& f = feedback[i];
      f = {};
      const bool represented = to_signal(state.position, f.position) && to_signal(state.velocity, f.velocity) &&
                               to_signal(state.current, f.current[0]);
      f.position_valid = newest_[i].time_ns != 0 && represented;
      f.position_time_ns = std::min(newest_[i].time_ns, now_ns_);
      f.fault = state.fault;
    }
  }

  void read_inputs(std::span<DigitalInputs<Signals>> inputs) const {
    for (std::size_t i = 0; i < newest_.size(); ++i) {
      const PowerStageState& state = newest_[i].state;
      inputs[i] = {};
      inputs[i].limit_negative = state.limit_negative;
      inputs[i].limit_positive = state.limit_positive;
      inputs[i].home = state.home;
    }
  }

  void read_protection(std::span<ProtectionInputs<Signals>> inputs) const {
    for (std::size_t i = 0; i < newest_.size(); ++i) {
      const PowerStageState& state = newest_[i].state;
      inputs[i] = {};
      to_signal(state.dc_link, inputs[i].dc_link);  // 16 bits of 0.1 V have a place in every format of voltages
      inputs[i].motor_temperature = static_cast<std::int16_t>(std::lround(10.0 * state.motor_temperature));
      inputs[i].stage_temperature = static_cast<std::int16_t>(std::lround(10.0 * state.stage_temperature));
      inputs[i].torque_off_a = state.torque_off_a;
      inputs[i].torque_off_b = state.torque_off_b;
    }
  }
  MotorSignalSet motor_signals(std::size_t axis) const {
    const PowerStageState& state = newest_[axis].state;
    return {.dc_link = state.has_dc_link,
            .motor_temperature = state.has_motor_temperature,
            .stage_temperature = state.has_stage_temperature,
            .torque_off = state.has_torque_off};
  }

  void write(std::span<const Command<Signals>> command) {
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      commands_[i].enable = command[i].enable;
      commands_[i].voltage =
          command[i].enable ? std::ldexp(command[i].voltage[0].raw(), -Signals::Voltage::fraction_bits) : 0.0;
    }
    client_.command(commands_);
  }

  void set_brake(std::size_t axis, bool released) { commands_[axis].release_brake = released; }

  // Tells every stage to switch off, beside the exchanges.
  void cut_power() noexcept { client_.cut_power(); }

  // frames_lost as long as a slave brings nothing new.
  Fault fault(std::size_t axis) const { return newest_[axis].fault; }

 private:
  // False where the value is not a number or has no place in the format.
  template <class T>
  static bool to_signal(double value, T& signal) {
    const double raw = std::round(std::ldexp(value, T::fraction_bits));
    if (!(raw >= static_cast<double>(T::lowest_raw) && raw <= static_cast<double>(T::highest_raw))) return false;
    signal = T::from_bounded_raw(static_cast<std::int64_t>(raw));
    return true;
  }

  ModbusClient& client_;
  TickClock& clock_;
  std::int64_t now_ns_ = 0;
  std::vector<PowerStageCommand> commands_;
  std::vector<PowerStageFeedback> newest_;
};

static_assert(WiredBackend<ModbusBackend> && KernelTimeBackend<ModbusBackend> && ProtectionBackend<ModbusBackend>);

}  // namespace stiction::hal
