// Digital inputs and outputs by GPIO beside a backend whose power stages and encoders are on another bus. What is
// wired here takes the place of what the other one says of the same switch; a fault of either is a fault.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "hal/gpio/index_latch.hpp"
#include "hal/gpio/inputs_outputs.hpp"
#include "hal/gpio/lines.hpp"

namespace stiction::hal {

template <WiredBackend B>
class BesideLines {
 public:
  using Signals = FixedSignals;
  static_assert(std::same_as<typename B::Signals, Signals>);

  // `backend` must outlive this. `axes`: one an axis of it, in its order. Throws GpioError. `chip`: name or path of the
  // gpiochip; `bias`: of its inputs; `watchdog`: of the pulse; `tracks`: of
  // a cam switch.
  BesideLines(B& backend, const std::string& chip, Bias bias, std::span<const AxisLines> axes,
              const WatchdogConfig& watchdog = {}, std::span<const LineConfig> tracks = {})
      : backend_(backend), lines_(chip, bias), io_(lines_, axes, watchdog, tracks), latches_(axes.size()) {
    if (axes.size() != backend.axis_count())
      throw GpioError("lines for a different number of axes than the machine has");
  }

  std::size_t axis_count() const { return backend_.axis_count(); }

  void begin() requires KernelTimeBackend<B> { backend_.begin(); }

  std::int64_t wait_for_tick() {
    now_ns_ = backend_.wait_for_tick();
    lines_.poll(now_ns_);
    return now_ns_;
  }

  void read(std::span<Feedback<Signals>> feedback) {
    backend_.read(feedback);
    for (std::size_t i = 0; i < latches_.size(); ++i) {
      feedback[i].fault |= io_.fault(i);
      latches_[i].observe(feedback[i]);
    }
  }

  // Off: first the lines; on: first the other bus, whose command is then a voltage of the controllers already.
  void write(std::span<const Command<Signals>> command) {
    for (std::size_t i = 0; i < command.size(); ++i)
      if (!command[i].enable) io_.set_enable(i, false);
    backend_.write(command);
    for (std::size_t i = 0; i < command.size(); ++i)
      if (command[i].enable) io_.set_enable(i, true);
    io_.pulse(now_ns_);
  }

  void read_inputs(std::span<DigitalInputs<Signals>> inputs) {
    backend_.read_inputs(inputs);
    for (std::size_t i = 0; i < latches_.size(); ++i) {
      io_.read_inputs(i, inputs[i]);
      if (io_.has_index(i)) take_index(i, inputs[i]);
    }
  }

  void read_protection(std::span<ProtectionInputs<Signals>> inputs) {
    if constexpr (ProtectionBackend<B>)
      backend_.read_protection(inputs);
    else
      for (auto& input : inputs) input = {};
    for (std::size_t i = 0; i < latches_.size(); ++i) io_.read_protection(i, inputs[i]);
  }
  MotorSignalSet motor_signals(std::size_t axis) {
    MotorSignalSet set = io_.motor_signals(axis);
    if constexpr (ProtectionBackend<B>) {
      const MotorSignalSet other = backend_.motor_signals(axis);
      set = {.hall = set.hall || other.hall,
             .dc_link = other.dc_link,
             .motor_temperature = other.motor_temperature,
             .stage_temperature = other.stage_temperature,
             .torque_off = set.torque_off || other.torque_off};
    }
    return set;
  }

  Fault fault(std::size_t axis) { return backend_.fault(axis); }
  void set_brake(std::size_t axis, bool released) { io_.set_brake(axis, released); }
  void set_output(std::size_t output, bool active) { io_.set_track(output, active); }

  // Every line goes inactive, which engages the brakes, then the other bus is told.
  void cut_power() noexcept {
    lines_.cut();
    backend_.cut_power();
  }

  B& backend() { return backend_; }
  const GpioInputsOutputs& lines() const { return io_; }

 private:
  void take_index(std::size_t axis, DigitalInputs<Signals>& inputs) const {
    inputs.index = false;
    for (const auto& edge : io_.index_edges(axis))
      if (const auto position = latches_[axis].position_at(edge.time_ns); edge.rising && position) {
        inputs.index = true;
        inputs.index_position = *position;
        return;
      }
  }

  B& backend_;
  Lines lines_;
  GpioInputsOutputs io_;
  std::vector<IndexLatch> latches_;
  std::int64_t now_ns_ = 0;
};

}  // namespace stiction::hal
