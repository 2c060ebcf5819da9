// The simulated machine as a backend, in logical time: waiting for a tick moves the plant on by one. The only place
// that knows both the control's border and the simulation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/backend.hpp"
#include "sim/control/conversion.hpp"
#include "sim/plant/axis_plant.hpp"

namespace stiction::hal {

template <class S>
class SimulatedBackend {
 public:
  using Signals = S;

  // `positions` (m): where the axes rest at the start, one an axis of the machine.
  SimulatedBackend(const sim::Machine& machine, std::span<const double> positions, std::uint64_t seed = 1)
      : period_ns_(std::llround(machine.timing.fast_period * 1e9)) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      plants_.emplace_back(machine.timing, machine.axes[i], positions[i], seed + i);
  }

  std::size_t axis_count() const { return plants_.size(); }
  sim::AxisPlant& plant(std::size_t axis) { return plants_[axis]; }
  const sim::AxisPlant& plant(std::size_t axis) const { return plants_[axis]; }

  std::int64_t wait_for_tick() {
    if (started_) {
      for (auto& plant : plants_) plant.advance_tick();
      now_ns_ += period_ns_;
    }
    started_ = true;
    return now_ns_;
  }

  void read(std::span<Feedback<S>> feedback) {
    for (std::size_t i = 0; i < plants_.size(); ++i) sample(plants_[i], feedback[i]);
  }

  void write(std::span<const Command<S>> command) {
    for (std::size_t i = 0; i < plants_.size(); ++i) {
      sim::PhaseValues voltage;
      for (std::size_t k = 0; k < 3; ++k) voltage[k] = sim::to_si(command[i].voltage[k]);
      plants_[i].command(voltage, command[i].enable);
    }
  }

 private:
  // What cannot be represented (a plant that ran away to infinity or NaN) reaches the control as a position that is
  // not valid or as a fault input, never as a number.
  void sample(sim::AxisPlant& plant, Feedback<S>& f) const {
    const auto position = sim::to_signal<typename S::Position>(plant.read_encoder());
    const auto velocity = sim::to_signal<typename S::Velocity>(plant.encoder_velocity());
    f.position_valid = position && velocity;
    if (f.position_valid) {
      f.position = *position;
      f.velocity = *velocity;
    }
    f.position_time_ns = now_ns_;
    f.fault = false;
    for (std::size_t k = 0; k < plant.phases(); ++k) {
      const auto current = sim::to_signal<typename S::Current>(plant.current()[k]);
      if (current)
        f.current[k] = *current;
      else
        f.fault = true;
    }
  }

  std::int64_t period_ns_;
  std::int64_t now_ns_ = 0;
  bool started_ = false;
  std::vector<sim::AxisPlant> plants_;
};

}  // namespace stiction::hal
