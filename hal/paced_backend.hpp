// A backend in logical time made to keep the kernel's: each of its ticks waits for a tick of the clock. So the drive's
// programme runs the simulated machine as it would run a real one, late ticks included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/backend.hpp"
#include "hal/tick_clock.hpp"

namespace stiction::hal {

template <Backend B, class Time = MonotonicTime>
class PacedBackend {
 public:
  using Signals = typename B::Signals;

  // `backend`: must outlive this; `period_ns`: of the fast loop; `time`: source of time, the kernel's or one of a test.
  PacedBackend(B& backend, std::int64_t period_ns, Time time = {}) : backend_(backend), clock_(period_ns, time) {}

  std::size_t axis_count() const { return backend_.axis_count(); }

  void begin() { clock_.restart(); }

  // Time is the backend's own. Ticks that the clock missed pass in the backend's world too, its commands held.
  std::int64_t wait_for_tick() {
    clock_.wait();
    for (std::uint64_t i = 0; i < clock_.missed_before(); ++i) backend_.wait_for_tick();
    return backend_.wait_for_tick();
  }

  void read(std::span<Feedback<Signals>> feedback) { backend_.read(feedback); }
  void write(std::span<const Command<Signals>> command) { backend_.write(command); }

  void read_inputs(std::span<DigitalInputs<Signals>> inputs) {
    if constexpr (WiredBackend<B>)
      backend_.read_inputs(inputs);
    else
      for (auto& input : inputs) input = {};
  }

  MotorSignalSet motor_signals(std::size_t axis) requires ProtectionBackend<B> { return backend_.motor_signals(axis); }
  void read_protection(std::span<ProtectionInputs<Signals>> inputs) requires ProtectionBackend<B> {
    backend_.read_protection(inputs);
  }
  void set_brake(std::size_t axis, bool released) requires BrakeBackend<B> { backend_.set_brake(axis, released); }
  LoadReading<Signals> read_load(std::size_t axis) requires LoadEncoderBackend<B> { return backend_.read_load(axis); }

  // The backend's, else the clock's.
  Fault fault(std::size_t axis) {
    if constexpr (WiredBackend<B>)
      if (const Fault own = backend_.fault(axis); own != Fault::none) return own;
    return clock_.fault();
  }

  BasicTickClock<Time>& clock() { return clock_; }
  const BasicTickClock<Time>& clock() const { return clock_; }

 private:
  B& backend_;
  BasicTickClock<Time> clock_;
};

}  // namespace stiction::hal
