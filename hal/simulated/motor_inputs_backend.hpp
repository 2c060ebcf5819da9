// Around a simulated backend: the signals of a motor and its power stage that the plant alone does not show, each as
// the true electrical angle makes it or as it is given on command: Hall signals, index mark, safe torque off, broken
// sensors.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "firmware/machine/model/machine.hpp"
#include "hal/backend.hpp"

namespace stiction::hal {

// What is given of an axis, held until changed. SI units, temperatures in degrees Celsius; none: as the plant has it.
struct MotorSignals {
  bool hall_wired = false;
  std::optional<std::uint8_t> hall;  // in the place of the signals
  std::optional<double> index;       // m, of the encoder's mark
  std::optional<double> dc_link, motor_temperature, stage_temperature;
  bool torque_off_a = false, torque_off_b = false;
};

template <Backend B>
class MotorInputsBackend {
 public:
  using Signals = typename B::Signals;
  using S = Signals;

  // `inner`: must outlive this; `machine`: whose motors they are.
  MotorInputsBackend(B& inner, const machine::Machine& machine)
      : inner_(inner), signals_(machine.axes.size()), feedback_(machine.axes.size()), before_(machine.axes.size()) {
    for (const auto& axis : machine.axes)
      motors_.push_back({axis.motor.pole_pair_pitch, axis.encoder.commutation_offset});
  }

  MotorSignals& signals(std::size_t axis) { return signals_[axis]; }
  bool brake_released(std::size_t axis) const { return released_ & (std::uint64_t{1} << axis); }

  std::size_t axis_count() const { return inner_.axis_count(); }
  std::int64_t wait_for_tick() { return inner_.wait_for_tick(); }
  void read(std::span<Feedback<S>> feedback) {
    before_ = feedback_;
    inner_.read(feedback);
    feedback_.assign(feedback.begin(), feedback.end());
  }
  // Safe torque off takes the power by itself.
  void write(std::span<const Command<S>> command) {
    commands_.assign(command.begin(), command.end());
    for (std::size_t i = 0; i < commands_.size(); ++i)
      if (signals_[i].torque_off_a || signals_[i].torque_off_b) commands_[i] = {};
    inner_.write(commands_);
  }
  void set_brake(std::size_t axis, bool released) {
    const auto bit = std::uint64_t{1} << axis;
    released_ = released ? released_ | bit : released_ & ~bit;
    inner_.set_brake(axis, released);
  }

  void read_inputs(std::span<DigitalInputs<S>> inputs) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      inputs[i] = {};
      const auto& given = signals_[i];
      const double x = machine::to_si(feedback_[i].position), before = machine::to_si(before_[i].position);
      if (given.hall_wired) inputs[i].hall = given.hall.value_or(hall_of(motors_[i], x));
      if (given.index && (before < *given.index) != (x < *given.index)) {
        inputs[i].index = true;
        machine::convert(*given.index, inputs[i].index_position);
      }
    }
  }
  Fault fault(std::size_t) const { return Fault::none; }

  LoadReading<S> read_load(std::size_t axis) requires LoadEncoderBackend<B> { return inner_.read_load(axis); }

  MotorSignalSet motor_signals(std::size_t axis) const {
    auto set = inner_.motor_signals(axis);
    set.hall = signals_[axis].hall_wired;
    return set;
  }
  void read_protection(std::span<ProtectionInputs<S>> inputs) {
    inner_.read_protection(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const auto& given = signals_[i];
      if (given.dc_link) machine::convert(*given.dc_link, inputs[i].dc_link);
      if (given.motor_temperature) inputs[i].motor_temperature = tenths(*given.motor_temperature);
      if (given.stage_temperature) inputs[i].stage_temperature = tenths(*given.stage_temperature);
      inputs[i].torque_off_a = given.torque_off_a;
      inputs[i].torque_off_b = given.torque_off_b;
    }
  }

 private:
  struct Motor {
    double pitch, offset;
  };
  static std::int16_t tenths(double celsius) { return static_cast<std::int16_t>(std::lround(10.0 * celsius)); }
  // Each of three signals is high for half of an electrical turn, from 0, 120 and 240 degrees on.
  static std::uint8_t hall_of(const Motor& motor, double x) {
    const double turns = x / motor.pitch + motor.offset / (2.0 * std::numbers::pi);
    std::uint8_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const double from = turns - k / 3.0;
      if (from - std::floor(from) < 0.5) code = static_cast<std::uint8_t>(code | (1u << k));
    }
    return code;
  }

  B& inner_;
  std::vector<MotorSignals> signals_;
  std::vector<Motor> motors_;
  std::vector<Feedback<S>> feedback_, before_;
  std::vector<Command<S>> commands_;
  std::uint64_t released_ = 0;
};

}  // namespace stiction::hal
