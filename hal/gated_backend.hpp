// A backend whose commands enable nothing while the power is cut (power_cut.hpp): a loop that stood still and goes on
// must not switch on what was switched off beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "hal/power_cut.hpp"

namespace stiction::hal {

template <Backend B>
class GatedBackend {
 public:
  using Signals = typename B::Signals;

  // `backend`, `cut`: must outlive this.
  GatedBackend(B& backend, const PowerCut& cut) : backend_(backend), cut_(cut), off_(backend.axis_count()) {}

  std::size_t axis_count() const { return backend_.axis_count(); }
  void begin() requires KernelTimeBackend<B> { backend_.begin(); }
  std::int64_t wait_for_tick() { return backend_.wait_for_tick(); }
  void read(std::span<Feedback<Signals>> feedback) { backend_.read(feedback); }
  void write(std::span<const Command<Signals>> command) { backend_.write(cut_.is_cut() ? off_ : command); }
  void read_inputs(std::span<DigitalInputs<Signals>> inputs) requires WiredBackend<B> { backend_.read_inputs(inputs); }
  Fault fault(std::size_t axis) requires WiredBackend<B> { return backend_.fault(axis); }
  MotorSignalSet motor_signals(std::size_t axis) requires ProtectionBackend<B> { return backend_.motor_signals(axis); }
  void read_protection(std::span<ProtectionInputs<Signals>> inputs) requires ProtectionBackend<B> {
    backend_.read_protection(inputs);
  }
  LoadReading<Signals> read_load(std::size_t axis) requires LoadEncoderBackend<B> { return backend_.read_load(axis); }
  void set_brake(std::size_t axis, bool released) requires BrakeBackend<B> {
    backend_.set_brake(axis, released && !cut_.is_cut());
  }

  void set_output(std::size_t output, bool active) requires OutputBackend<B> {
    backend_.set_output(output, active && !cut_.is_cut());
  }

 private:
  B& backend_;
  const PowerCut& cut_;
  const std::vector<Command<Signals>> off_;
};

}  // namespace stiction::hal
