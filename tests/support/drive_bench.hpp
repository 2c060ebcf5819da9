// The cross table as drives over a backend with faults on command: switches on, moves circles, keeps what happened.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/machine/configuration/drive_configuration.hpp"
#include "hal/drive_loop.hpp"
#include "hal/simulated/faulty_backend.hpp"
#include "hal/simulated/simulated_backend.hpp"
#include "sim/experiment/circle_path.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "tests/support/closed_loop.hpp"

namespace stiction::test {

// What a machine file without [drive] says.
inline machine::DriveSetup drive_setup(const machine::Machine& machine) {
  machine::DriveSetup setup;
  for (const auto& axis : machine.axes) {
    auto& of_axis = setup.axes[axis.name];
    const double limit = axis.inverter.current_limit * axis.motor.count;
    of_axis.encoder_jump = 5e-6;
    of_axis.current_sum = limit / 20.0;
    of_axis.runaway_current = limit / 5.0;
    of_axis.negative_end = -axis.travel / 2.0;
    of_axis.positive_end = axis.travel / 2.0;
  }
  return setup;
}

// A circle that begins at rest where the axes are. Its centre lies on the way to the machine's zero, so that circles
// one after the other stay around it.
class CircleFromHere {
 public:
  CircleFromHere(const sim::CircleSettings& settings, double x, double y) : path_(settings) {
    const double distance = std::hypot(x, y);
    cosine_ = distance > 0.0 ? x / distance : 1.0;
    sine_ = distance > 0.0 ? y / distance : 0.0;
    centre_ = {x - settings.radius * cosine_, y - settings.radius * sine_};
  }

  std::array<sim::AxisSetPoint, 2> at(double t) const {
    const auto [a, b] = path_.at(t).axes;
    const auto turned = [&](double u, double v) {
      return std::array{cosine_ * u - sine_ * v, sine_ * u + cosine_ * v};
    };
    const auto x = turned(a.position, b.position), v = turned(a.velocity, b.velocity),
               acceleration = turned(a.acceleration, b.acceleration);
    return {{{centre_[0] + x[0], v[0], acceleration[0]}, {centre_[1] + x[1], v[1], acceleration[1]}}};
  }

 private:
  sim::CirclePath path_;
  double cosine_, sine_;
  std::array<double, 2> centre_{};
};

template <class Signals = FixedSignals>
class DriveBench {
 public:
  using S = Signals;
  using Simulated = hal::SimulatedBackend<S>;
  using Faulty = hal::FaultyBackend<Simulated>;
  using Loop = hal::DriveLoop<Faulty>;

  enum class Want { off, on, quick_stop };

  DriveBench(const machine::Machine& machine, const machine::DriveSetup& setup, std::uint64_t seed = 1)
      : DriveBench(machine, machine::configure_drives<S>(machine, setup), seed) {}
  DriveBench(const machine::Machine& machine, const std::vector<ServoDriveConfig<S>>& drives, std::uint64_t seed = 1)
      : period(machine.timing.fast_period),
        simulated(machine, std::array{0.09, 0.0}, seed),
        backend(simulated, machine::fast_period_ns(machine.timing), machine.axes[0].encoder.increment),
        loop(backend, configurations<S>(machine), drives, ticker_of(machine)) {
    hold_here();
  }

  // The source of set-points stands still where the axes are.
  void hold_here() {
    for (std::size_t i = 0; i < 2; ++i) {
      set_[i] = {};
      set_[i].position = loop.drive(i).position();
    }
    motion_ = nullptr;
  }
  void move(const sim::CircleSettings& settings) {
    follow([circle = CircleFromHere(settings, position(0), position(1))](double t) { return circle.at(t); });
  }
  // Straight to a place (m), jerk-limited, at rest at both ends.
  void travel_to(const std::array<double, 2>& place, double time) {
    const std::array from{position(0), position(1)};
    follow([=](double t) {
      const double part = std::min(t / time, 1.0), angle = 2.0 * std::numbers::pi * part;
      std::array<sim::AxisSetPoint, 2> set;
      for (std::size_t i = 0; i < 2; ++i) {
        const double way = place[i] - from[i];
        set[i].position = from[i] + way * (part - std::sin(angle) / (2.0 * std::numbers::pi));
        set[i].velocity = way / time * (1.0 - std::cos(angle));
        set[i].acceleration = way * 2.0 * std::numbers::pi / (time * time) * std::sin(angle);
      }
      return set;
    });
  }

  void tick() {
    if (before_tick) before_tick();
    for (std::size_t i = 0; i < 2; ++i) {
      loop.set_controlword(i, word(i));
      loop.set_mode(i, mode);
    }
    set_ = next_set_points();
    ++motion_ticks_;
    if (invalid_set_point) set_[*invalid_set_point].valid = false;
    loop.tick(set_);
    ++ticks;
    hal::AxisEvent<S> event;
    while (loop.next_event(event)) events.push_back(event);
  }
  // What the coming tick is sent.
  std::array<SetPoint<S>, 2> next_set_points() const {
    if (!motion_) return set_;
    const auto si = motion_(static_cast<double>(motion_ticks_ + 1) * period);
    return {sim::to_set_point<S>(si[0]), sim::to_set_point<S>(si[1])};
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  // Switches on and waits for it; false when the drives do not get there within 0.1 s.
  bool enable() {
    want = Want::on;
    for (int i = 0; i < 1600; ++i) {
      if (loop.all_in(DriveState::operation_enabled)) return true;
      hold_here();
      tick();
    }
    return false;
  }
  // A reset of every axis; false when one of them does not leave its fault.
  bool reset() {
    want = Want::off;
    run(2);
    resetting_ = true;
    run(2);
    resetting_ = false;
    tick();
    return !loop.faulted();
  }

  double position(std::size_t axis) const { return machine::to_si(loop.drive(axis).position()); }  // m, measured
  double set_position(std::size_t axis) const { return machine::to_si(set_[axis].position); }      // m, sent last
  bool powered(std::size_t axis) const { return loop.drive(axis).powered(); }

  double period;
  Simulated simulated;
  Faulty backend;
  Loop loop;
  Want want = Want::off;
  OperationMode mode = OperationMode::cyclic_position;
  std::array<std::optional<std::uint16_t>, 2> override_word;  // in place of what `want` gives
  std::uint16_t extra_bits = 0;                               // of the controlwords
  std::optional<std::size_t> invalid_set_point;               // of this axis
  std::function<void()> before_tick;
  std::uint64_t ticks = 0;
  std::vector<hal::AxisEvent<S>> events;

 private:
  void follow(std::function<std::array<sim::AxisSetPoint, 2>(double)> motion) {
    hold_here();
    motion_ = std::move(motion);
    motion_ticks_ = 0;
  }

  std::uint16_t word(std::size_t axis) const {
    if (override_word[axis]) return *override_word[axis];
    if (resetting_) return controlword::fault_reset;
    if (want == Want::off) return controlword::disable_voltage;
    if (want == Want::quick_stop) return controlword::quick_stop;
    return static_cast<std::uint16_t>(controlword_to_enable(loop.state(axis)) | extra_bits);
  }

  bool resetting_ = false;
  std::array<SetPoint<S>, 2> set_{};
  std::function<std::array<sim::AxisSetPoint, 2>(double)> motion_;  // over the time since its start
  std::uint64_t motion_ticks_ = 0;
};

}  // namespace stiction::test
