// What a backend must give and when: the border between the control loop and the world.
//
// A tick of the fast loop is: wait_for_tick(), read(), control, write(). Times are on one clock, in ns, starting
// anywhere; a backend of a simulated machine keeps logical time, so that a run is repeatable to the bit.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "stiction/drive/exchange.hpp"
#include "stiction/drive/faults.hpp"

namespace stiction::hal {

template <class B>
concept Backend = requires(B backend, std::span<Feedback<typename B::Signals>> feedback,
                           std::span<const Command<typename B::Signals>> command) {
  typename B::Signals;

  { backend.axis_count() } -> std::convertible_to<std::size_t>;

  // Blocks until the next tick and returns its time. Ticks follow each other by the fast period; the first one is the
  // start.
  { backend.wait_for_tick() } -> std::same_as<std::int64_t>;

  // The state of every axis for this tick: the newest encoder position with the time at which it was sampled (at or
  // before the tick) and whether it is valid, the phase currents of this tick, and the fault inputs. A position that
  // is not new keeps its old time stamp; the axis bears two such ticks in a row, a third is a fault. A value that the
  // world gave but the format cannot hold is not valid.
  { backend.read(feedback) } -> std::same_as<void>;

  // The voltages of this tick and whether the power stage may be on. They may act later by the inverter's delay but
  // must act in order; a command without enable must turn the power stage off.
  { backend.write(command) } -> std::same_as<void>;
};

// What a backend that keeps the kernel's time gives beyond that; in logical time preparation takes none.
template <class B>
concept KernelTimeBackend = Backend<B> && requires(B backend) {
  // The next tick is the loop's first: what passed before it, of time or of the world, is neither late nor missed nor
  // lost. Called between two ticks, with the power off; power stages must get no command by it.
  { backend.begin() } -> std::same_as<void>;
};

// What a backend over wires gives beyond that; the simulated one has no wires.
template <class B>
concept WiredBackend = Backend<B> &&
    requires(B backend, std::size_t axis, std::span<DigitalInputs<typename B::Signals>> inputs) {
  // Switches and marks of every axis for this tick; all false where none are wired.
  { backend.read_inputs(inputs) } -> std::same_as<void>;

  // What the backend's own watch says of an axis in this tick: a fault with Detector::backend, or none. It stays as
  // long as its cause does.
  { backend.fault(axis) } -> std::same_as<Fault>;
};

// A backend that drives holding brakes. Asked before each write(), whose command it goes with; a brake is engaged while
// its power stage is off, whatever was asked.
template <class B>
concept BrakeBackend = Backend<B> && requires(B backend, std::size_t axis, bool released) {
  { backend.set_brake(axis, released) } -> std::same_as<void>;
};

// A backend with digital outputs for the whole machine, such as the tracks of a cam switch. They go inactive where the
// power is cut, whatever was set.
template <class B>
concept OutputBackend = Backend<B> && requires(B backend, std::size_t output, bool active) {
  { backend.set_output(output, active) } -> std::same_as<void>;
};

// A backend that tells of power stage and motor what their protection watches. One that does not leaves all of it at
// zero: what a machine file asks to be watched is then refused by who opens the backend.
template <class B>
concept ProtectionBackend = Backend<B> &&
    requires(B backend, std::size_t axis, std::span<ProtectionInputs<typename B::Signals>> inputs) {
  // Of every axis for this tick; once a tick.
  { backend.read_protection(inputs) } -> std::same_as<void>;

  // What an axis has of it, and whether it has Hall signals (read_inputs). Known before the loop begins.
  { backend.motor_signals(axis) } -> std::same_as<MotorSignalSet>;
};

// A backend with encoders at loads, which are measured and close no loop.
template <class B>
concept LoadEncoderBackend = Backend<B> && requires(B backend, std::size_t axis) {
  // Of this tick; at most once a tick.
  { backend.read_load(axis) } -> std::same_as<LoadReading<typename B::Signals>>;
};

}  // namespace stiction::hal
