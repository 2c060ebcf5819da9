// A machine on GPIO alone: incremental encoders by the edges of two lines, voltages by the kernel's PWM class, enable,
// brake, fault and switches by lines. There is no current on it: it suits axes whose power stage takes a voltage as it
// is (motor model "force"), not those whose current controllers run in the drive.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "hal/gpio/config.hpp"
#include "hal/gpio/inputs_outputs.hpp"
#include "hal/gpio/lines.hpp"
#include "hal/gpio/pwm.hpp"
#include "hal/gpio/quadrature_input.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::hal {

class GpioBackend {
 public:
  using Signals = FixedSignals;

  // `period_ns` of the fast loop. Reserves everything and enables nothing. Throws GpioError.
  GpioBackend(const GpioBackendConfig& config, std::int64_t period_ns);
  ~GpioBackend();  // power stages off before anything else is given back
  GpioBackend(const GpioBackend&) = delete;
  GpioBackend& operator=(const GpioBackend&) = delete;

  std::size_t axis_count() const { return axes_.size(); }
  void begin() { clock_.restart(); }
  std::int64_t wait_for_tick();
  void read(std::span<Feedback<Signals>> feedback) const;
  void write(std::span<const Command<Signals>> command);
  void read_inputs(std::span<DigitalInputs<Signals>> inputs);

  void read_protection(std::span<ProtectionInputs<Signals>> inputs) const;
  MotorSignalSet motor_signals(std::size_t axis) const { return io_.motor_signals(axis); }

  // What the encoder's edges show; a chip or a PWM that stopped answering reaches the axis as its fault input instead.
  Fault fault(std::size_t axis) const {
    return encoder_fault(axis) == QuadratureFault::none ? Fault::none : Fault::encoder_signal;
  }
  QuadratureFault encoder_fault(std::size_t axis) const { return axes_[axis]->encoder.fault(); }
  QuadratureFault last_encoder_fault(std::size_t axis) const { return axes_[axis]->encoder.last_fault(); }
  std::uint64_t lost_edges(std::size_t axis) const;  // at least, since the start

  void set_brake(std::size_t axis, bool released) { io_.set_brake(axis, released); }
  void set_output(std::size_t output, bool active) { io_.set_track(output, active); }

  // Every line goes inactive, which engages the brakes, and the voltages go to rest.
  void cut_power() noexcept {
    lines_.cut();
    for (auto& axis : axes_) axis->bridge.rest();
  }

  TickClock& clock() { return clock_; }

 private:
  struct Axis {
    Axis(Lines& lines, const GpioAxisConfig& config)
        : encoder(lines, config.encoder, config.lines.name), bridge(config.pwm) {}
    QuadratureInput encoder;
    PwmBridge bridge;
  };

  TickClock clock_;
  Lines lines_;
  GpioInputsOutputs io_;
  std::vector<std::unique_ptr<Axis>> axes_;
  std::int64_t now_ns_ = 0;
};

static_assert(WiredBackend<GpioBackend> && BrakeBackend<GpioBackend> && KernelTimeBackend<GpioBackend> &&
              ProtectionBackend<GpioBackend>);

}  // namespace stiction::hal
