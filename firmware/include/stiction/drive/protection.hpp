// What protects motor and power stage: thermal models of both (I2t), the limits of the DC link, temperatures, and the
// two channels of safe torque off, which switch the power off by themselves and are only seen here. Rows of fault_table
// with Detector::protection. Fixed work but for the ticks in which the thermal models step, one in sixteen.
#pragma once

#include <array>
#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/drive/faults.hpp"
#include "stiction/drive/thermal_model.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction {

template <class S>
struct ProtectionConfig {
  bool used = false;
  bool three_phase = false;
  ThermalModel::Config motor{}, stage{};  // of a step of ticks_a_step ticks
  bool watches_dc_high = false, watches_dc_low = false;
  typename S::Voltage dc_link_high{}, dc_link_low{};
  bool watches_motor_temperature = false, watches_stage_temperature = false;
  std::int16_t motor_temperature = 0, stage_temperature = 0;  // tenths of a degree Celsius
  bool torque_off_wired = false;
};

template <class S>
class Protection {
 public:
  static constexpr std::uint32_t ticks_a_step = 16;              // of the thermal models
  static constexpr std::uint8_t row_ticks = 16;                  // of a temperature and of an under-voltage
  static constexpr std::uint16_t channel_ticks = 3200;           // 200 ms at 62.5 us
  static constexpr std::int16_t coldest = -550, hottest = 3000;  // that a sensor shows, tenths of a degree Celsius

  explicit constexpr Protection(const ProtectionConfig<S>& config) : config_(config) {}

  constexpr bool used() const { return config_.used; }
  // Whether a channel of safe torque off is open.
  constexpr bool torque_off() const { return torque_off_; }
  constexpr int motor_percent() const { return motor_.percent(); }
  // Of the hottest phase, as ThermalModel::state().
  constexpr std::int64_t stage_state() const {
    std::int64_t most = 0;
    for (const auto& phase : stage_) most = phase.state() > most ? phase.state() : most;
    return most;
  }
  constexpr const ThermalModel& motor() const { return motor_; }
  constexpr const ProtectionInputs<S>& inputs() const { return inputs_; }

  // Once a tick. The fault that holds in it, or none; it stays as long as its cause does. `feedback`: currents of this
  // tick; `inputs`: of this tick; `powered`: whether the power stage was on since the last tick.
  constexpr Fault step(const Feedback<S>& feedback, const ProtectionInputs<S>& inputs, bool powered) {
    inputs_ = inputs;
    heat(feedback);
    Fault fault = Fault::none;
    const auto take = [&fault](bool holds, Fault found) { fault = holds ? found : fault; };
    take(motor_overload_, Fault::motor_overload);
    take(stage_overload_, Fault::stage_overload);
    watch_temperatures(inputs);
    take(motor_hot_ == row_ticks, Fault::motor_temperature);
    take(stage_hot_ == row_ticks, Fault::stage_temperature);
    take(no_sensor_ == row_ticks, Fault::temperature_sensor);
    low_ = next(low_, config_.watches_dc_low && powered && inputs.dc_link < config_.dc_link_low);
    take(low_ == row_ticks, Fault::dc_link_low);
    take(config_.watches_dc_high && inputs.dc_link > config_.dc_link_high, Fault::dc_link_high);
    watch_torque_off(inputs);
    take(differ_ == channel_ticks, Fault::torque_off_channels);
    in_motion_ = torque_off_ && (powered || in_motion_);
    take(in_motion_, Fault::torque_off_in_motion);
    return fault;
  }

 private:
  static constexpr std::uint8_t next(std::uint8_t row, bool holds) {
    if (!holds) return 0;
    return row < row_ticks ? static_cast<std::uint8_t>(row + 1) : row;
  }

  constexpr void heat(const Feedback<S>& feedback) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t raw = feedback.current[k].raw();
      squares_[k] += (raw * raw) >> S::Current::fraction_bits;
    }
    if (++tick_ < ticks_a_step) return;
    tick_ = 0;
    std::array<std::int64_t, 3> mean{};
    for (std::size_t k = 0; k < 3; ++k) {
      mean[k] = squares_[k] / ticks_a_step;
      squares_[k] = 0;
    }
    // Of three phases two thirds of the sum are the square of the amplitude, as is twice the mean of each in turning.
    const std::int64_t sum = mean[0] + mean[1] + mean[2];
    if (config_.motor.per_square != 0) motor_.step(config_.motor, config_.three_phase ? 2 * sum / 3 : mean[0]);
    for (std::size_t k = 0; k < 3; ++k)
      if (config_.stage.per_square != 0 && (config_.three_phase || k == 0))
        stage_[k].step(config_.stage, config_.three_phase ? 2 * mean[k] : mean[k]);
    motor_overload_ = motor_.tripped() || (motor_overload_ && motor_.warm());
    bool tripped = false, warm = false;
    for (const auto& phase : stage_) {
      tripped |= phase.tripped();
      warm |= phase.warm();
    }
    stage_overload_ = tripped || (stage_overload_ && warm);
  }

  constexpr void watch_temperatures(const ProtectionInputs<S>& inputs) {
    const auto outside = [](std::int16_t t) { return t < coldest || t > hottest; };
    const bool motor = config_.watches_motor_temperature, stage = config_.watches_stage_temperature;
    const bool motor_gone = motor && outside(inputs.motor_temperature);
    const bool stage_gone = stage && outside(inputs.stage_temperature);
    motor_hot_ = next(motor_hot_, motor && !motor_gone && inputs.motor_temperature > config_.motor_temperature);
    stage_hot_ = next(stage_hot_, stage && !stage_gone && inputs.stage_temperature > config_.stage_temperature);
    no_sensor_ = next(no_sensor_, motor_gone || stage_gone);
  }

  constexpr void watch_torque_off(const ProtectionInputs<S>& inputs) {
    const bool wired = config_.torque_off_wired;
    torque_off_ = wired && (inputs.torque_off_a || inputs.torque_off_b);
    const bool differs = wired && inputs.torque_off_a != inputs.torque_off_b;
    differ_ = !differs ? 0 : differ_ < channel_ticks ? static_cast<std::uint16_t>(differ_ + 1) : differ_;
  }

  ProtectionConfig<S> config_;
  ProtectionInputs<S> inputs_{};
  std::array<std::int64_t, 3> squares_{};
  std::uint32_t tick_ = 0;
  ThermalModel motor_;
  std::array<ThermalModel, 3> stage_;
  bool motor_overload_ = false, stage_overload_ = false, torque_off_ = false, in_motion_ = false;
  std::uint8_t motor_hot_ = 0, stage_hot_ = 0, no_sensor_ = 0, low_ = 0;
  std::uint16_t differ_ = 0;
};

}  // namespace stiction
