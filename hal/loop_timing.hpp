// Where the time of a tick goes: a histogram for each part of the loop, always on. Costs one reading of the clock a
// part (vDSO, no system call; 30 ns) and is read by another thread while the loop runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/backend.hpp"
#include "hal/tick_clock.hpp"
#include "hal/time_histogram.hpp"

namespace stiction::hal {

// In the order of a tick. Whoever drives the loop says when trace and set-points end; what it does not say belongs to
// the part that ends next.
enum class LoopPart : std::uint8_t { wait, read, trace, set_point, control, write };
inline constexpr std::array<const char*, 6> loop_part_names{"wait", "read", "trace", "set_point", "control", "write"};

template <class Time>
class BasicLoopTiming {
 public:
  explicit BasicLoopTiming(Time time = {}) : time_(time) { restart(); }

  // The loop begins now; what was measured before is forgotten. Before other threads read the figures.
  void restart() {
    for (auto& part : parts_) part.clear();
    work_.clear();
    woke_ns_ = 0;
    last_ns_ = time_.now_ns();
  }

  // The time since the last call of this or finish() went into `part`.
  void lap(LoopPart part) {
    const std::int64_t now = time_.now_ns();
    parts_[static_cast<std::size_t>(part)].add(now - last_ns_);
    last_ns_ = now;
    if (part == LoopPart::wait) woke_ns_ = now;
  }

  // The work of this tick is done; waiting begins.
  void finish() {
    last_ns_ = time_.now_ns();
    if (woke_ns_ != 0) work_.add(last_ns_ - woke_ns_);
  }

  const TimeHistogram& part(LoopPart part) const { return parts_[static_cast<std::size_t>(part)]; }
  const TimeHistogram& work() const { return work_; }  // all of a tick but waiting

 private:
  [[no_unique_address]] Time time_;
  std::int64_t last_ns_ = 0;
  std::int64_t woke_ns_ = 0;  // 0: the loop has not begun
  std::array<TimeHistogram, loop_part_names.size()> parts_;
  TimeHistogram work_;
};

using LoopTiming = BasicLoopTiming<MonotonicTime>;

// A backend that measures itself and, from the end of its read to the start of its write, the control between.
template <Backend B, class Time = MonotonicTime>
class TimedBackend {
 public:
  using Signals = typename B::Signals;

  TimedBackend(B& backend, BasicLoopTiming<Time>& timing) : backend_(backend), timing_(timing) {}

  std::size_t axis_count() const { return backend_.axis_count(); }

  void begin() requires KernelTimeBackend<B> {
    backend_.begin();
    timing_.restart();
  }

  std::int64_t wait_for_tick() {
    timing_.finish();
    const std::int64_t now_ns = backend_.wait_for_tick();
    timing_.lap(LoopPart::wait);
    return now_ns;
  }

  void read(std::span<Feedback<Signals>> feedback) {
    backend_.read(feedback);
    timing_.lap(LoopPart::read);
  }

  void write(std::span<const Command<Signals>> command) {
    timing_.lap(LoopPart::control);
    backend_.write(command);
    timing_.lap(LoopPart::write);
  }

  void read_inputs(std::span<DigitalInputs<Signals>> inputs) requires WiredBackend<B> {
    backend_.read_inputs(inputs);
    timing_.lap(LoopPart::read);
  }

  Fault fault(std::size_t axis) requires WiredBackend<B> { return backend_.fault(axis); }

  MotorSignalSet motor_signals(std::size_t axis) requires ProtectionBackend<B> { return backend_.motor_signals(axis); }
  void read_protection(std::span<ProtectionInputs<Signals>> inputs) requires ProtectionBackend<B> {
    backend_.read_protection(inputs);
    timing_.lap(LoopPart::read);
  }

  LoadReading<Signals> read_load(std::size_t axis) requires LoadEncoderBackend<B> { return backend_.read_load(axis); }
  void set_brake(std::size_t axis, bool released) requires BrakeBackend<B> { backend_.set_brake(axis, released); }
  void set_output(std::size_t output, bool active) requires OutputBackend<B> { backend_.set_output(output, active); }

 private:
  B& backend_;
  BasicLoopTiming<Time>& timing_;
};

}  // namespace stiction::hal
