// All axes of a machine as drives over a backend: the control loop with state machines, supervision, homing and brakes
// around it. A fault of one axis stops the others by a quick stop each; none can be enabled before every fault is
// reset. Allocates at construction only.
//
// Use: a tick is set_controlword()/set_mode()/trip() as wanted, then tick(set_points), then what became of it:
// statusword(), fault(), next_event(). stiction::controlword_to_enable() walks an axis to operation enabled.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "hal/control_loop.hpp"
#include "hal/tick_watch.hpp"
#include "stiction/drive/servo_drive.hpp"

namespace stiction::hal {

template <class S>
struct AxisEvent {
  std::size_t axis = 0;
  DriveEvent<S> event{};
};

template <Backend B>
class DriveLoop {
 public:
  using S = typename B::Signals;

  // Events that wait for next_event(); what comes on top is counted and dropped.
  static constexpr std::size_t event_capacity = 64;

  // One of each configuration an axis. The first tick happens here, with the power off. `backend`: must outlive this;
  // `axes`, `drives`: configurations in the order of the backend; `ticker`: period and slow ticks; `compensations`: as
  // many, or none.
  DriveLoop(B& backend, std::span<const AxisConfig<S>> axes, std::span<const ServoDriveConfig<S>> drives, Ticker ticker,
            std::span<const FrictionCompensationConfig<S>> compensations = {})
      : backend_(backend),
        loop_(backend, behind_the_drives(axes, drives), ticker, compensations, FaultScope::own_axis),
        watch_(ticker.period_ns()),
        demands_(drives.size()),
        trips_(drives.size(), Fault::none),
        inputs_(drives.size()),
        set_(drives.size()) {
    drives_.reserve(drives.size());
    for (const auto& config : drives) {
      drives_.emplace_back(config);
      protections_.emplace_back(config.protection);
      protects_ |= config.protection.used;
    }
    protection_inputs_.resize(drives.size());
    start_drives();
  }

  std::size_t axis_count() const { return drives_.size(); }

  // Hold until changed.
  void set_controlword(std::size_t axis, std::uint16_t word) { demands_[axis].controlword = word; }
  void set_mode(std::size_t axis, OperationMode mode) { demands_[axis].mode = mode; }
  // To standstill under power in place of the set-points.
  void set_braking(std::size_t axis, bool brakes) { demands_[axis].brake = brakes; }
  // A stop by a word, or for a fault of a different axis, may take the set-points on to standstill.
  void set_along(std::size_t axis, bool along) { demands_[axis].along = along; }
  void set_velocity_offset(std::size_t axis, typename S::Velocity offset) { demands_[axis].velocity_offset = offset; }
  // An output for the whole machine, at once; where the backend has none, none.
  void set_output(std::size_t output, bool active) {
    if constexpr (OutputBackend<B>) backend_.set_output(output, active);
  }
  // A fault that the programme sees (Detector::programme), in the coming tick. As long as its cause holds it is to be
  // repeated each tick: no reset is taken in a tick with one.
  void trip(std::size_t axis, Fault fault) { trips_[axis] = fault; }
  void trip(Fault fault) {
    for (auto& trip : trips_) trip = fault;
  }

  // The loop begins now, after a preparation since construction that may have taken as long as it liked: makes the
  // first tick again where the backend keeps the kernel's time, so that the first tick() has a time and feedback of
  // now, and what the preparation took is no lateness. Once, before the first tick().
  void begin() {
    if constexpr (KernelTimeBackend<B>) {
      backend_.begin();
      loop_.start();
      start_drives();
    }
    watch_.restart();
  }

  // The load of an axis in this tick, in the machine's coordinates: by an encoder at it, where the backend has one, or
  // by that of the axis. At most once a tick. `own`: by the axis' own encoder.
  LoadReading<S> load(std::size_t axis, bool own) {
    const auto& feedback = loop_.feedback()[axis];
    LoadReading<S> reading{feedback.position, own && feedback.position_valid};
    if constexpr (LoadEncoderBackend<B>)
      if (!own) reading = backend_.read_load(axis);
    SaturationCounter beyond;
    reading.position = narrow<typename S::Position>(reading.position - drives_[axis].origin(), beyond);
    return reading;
  }

  // One tick with a set-point an axis (csp, of the machine's coordinates), then waits for the next.
  void tick(std::span<const SetPoint<S>> set_points) {
    if constexpr (WiredBackend<B>) backend_.read_inputs(inputs_);
    if constexpr (ProtectionBackend<B>)
      if (protects_) backend_.read_protection(protection_inputs_);
    const Fault clock = watch_.step(loop_.now_ns());
    const bool stop_all = faulted();
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      demands_[i].set_point = set_points[i];
      demands_[i].quick_stop = stop_all;
      demands_[i].causes = {trips_[i], clock, backend_fault(i), protection_fault(i)};
      demands_[i].torque_off = protections_[i].torque_off();
      set_[i] = drives_[i].before(demands_[i], loop_.feedback()[i], inputs_[i], loop_.now_ns(), loop_.axes()[i]);
      note(i);
      if constexpr (BrakeBackend<B>) backend_.set_brake(i, drives_[i].brake_released());
      trips_[i] = Fault::none;
    }
    loop_.tick(set_);
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      drives_[i].after(loop_.signals()[i], loop_.axes()[i]);
      note(i);
    }
  }

  // Of the last tick.
  const ServoDrive<S>& drive(std::size_t axis) const { return drives_[axis]; }
  DriveState state(std::size_t axis) const { return drives_[axis].state(); }
  std::uint16_t statusword(std::size_t axis) const { return drives_[axis].statusword(); }
  Fault fault(std::size_t axis) const { return drives_[axis].fault(); }
  const Protection<S>& protection(std::size_t axis) const { return protections_[axis]; }
  const DigitalInputs<S>& inputs(std::size_t axis) const { return inputs_[axis]; }
  bool faulted() const {
    for (const auto& drive : drives_)
      if (drive.fault() != Fault::none) return true;
    return false;
  }
  bool all_in(DriveState state) const {
    for (const auto& drive : drives_)
      if (drive.state() != state) return false;
    return true;
  }
  const ControlLoop<B>& loop() const { return loop_; }  // signals, feedback, time
  std::int64_t now_ns() const { return loop_.now_ns(); }
  std::uint64_t missed_ticks() const { return watch_.missed(); }

  // Takes the oldest event that waits; false where there is none.
  bool next_event(AxisEvent<S>& event) {
    if (waiting_ == 0) return false;
    event = events_[first_];
    first_ = (first_ + 1) % event_capacity;
    --waiting_;
    return true;
  }
  std::uint64_t dropped_events() const { return dropped_; }

 private:
  // The cascade's own limit of the following error is for what the drive's stop does not end (servo_drive.hpp).
  static std::vector<AxisConfig<S>> behind_the_drives(std::span<const AxisConfig<S>> axes,
                                                      std::span<const ServoDriveConfig<S>> drives) {
    std::vector<AxisConfig<S>> configs(axes.begin(), axes.end());
    SaturationCounter meant;
    for (std::size_t i = 0; i < configs.size(); ++i) {
      configs[i].following_error_fault =
          saturated_sum(configs[i].following_error_fault, drives[i].following_error, meant);
      if (drives[i].commutation.method != CommutationMethod::encoder_zero)
        configs[i].current_loop = CurrentLoop::three_phase_offset;
    }
    return configs;
  }

  void start_drives() {
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].start(loop_.feedback()[i], loop_.axes()[i]);
  }

  Fault protection_fault(std::size_t axis) {
    if (!protections_[axis].used()) return Fault::none;
    return protections_[axis].step(loop_.feedback()[axis], protection_inputs_[axis], drives_[axis].powered());
  }

  Fault backend_fault(std::size_t axis) {
    if constexpr (WiredBackend<B>) return backend_.fault(axis);
    return Fault::none;
  }

  void note(std::size_t axis) {
    for (const auto& event : drives_[axis].events()) {
      if (event.fault == Fault::none) continue;
      if (waiting_ == event_capacity) {
        ++dropped_;
        continue;
      }
      events_[(first_ + waiting_) % event_capacity] = {axis, event};
      ++waiting_;
    }
  }

  B& backend_;
  ControlLoop<B> loop_;
  TickWatch watch_;
  std::vector<ServoDrive<S>> drives_;
  std::vector<Protection<S>> protections_;
  std::vector<ProtectionInputs<S>> protection_inputs_;
  bool protects_ = false;  // any of them
  std::vector<DriveDemand<S>> demands_;
  std::vector<Fault> trips_;
  std::vector<DigitalInputs<S>> inputs_;
  std::vector<SetPoint<S>> set_;
  std::array<AxisEvent<S>, event_capacity> events_{};
  std::size_t first_ = 0, waiting_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace stiction::hal
