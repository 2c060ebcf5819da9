// The simulated machine as a backend, in logical time: waiting for a tick moves the plant on by one. The only place
// that knows both the control's border and the simulation.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "hal/backend.hpp"
#include "sim/plant/axis_plant.hpp"
#include "sim/plant/drive_supply.hpp"

namespace stiction::hal {

template <class S>
class SimulatedBackend {
 public:
  using Signals = S;

  // `positions` (m): where the axes rest at the start, one an axis of the machine. `machine`: to simulate; `seed`: of
  // the encoder noise.
  SimulatedBackend(const machine::Machine& machine, std::span<const double> positions, std::uint64_t seed = 1)
      : period_ns_(std::llround(machine.timing.fast_period * 1e9)) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      plants_.emplace_back(machine.timing, machine.axes[i], positions[i], seed + i);
    for (const auto& axis : machine.axes) supplies_.emplace_back(axis, machine.timing.fast_period);
    coupled_ = plants_.size() == 2 && (plants_[0].coupled() || plants_[1].coupled());
  }

  std::size_t axis_count() const { return plants_.size(); }
  sim::AxisPlant& plant(std::size_t axis) { return plants_[axis]; }
  const sim::AxisPlant& plant(std::size_t axis) const { return plants_[axis]; }

  std::int64_t wait_for_tick() {
    if (started_) {
      if (coupled_) [[unlikely]]
        advance_coupled();
      else
        for (auto& plant : plants_) plant.advance_tick();
      now_ns_ += period_ns_;
    }
    started_ = true;
    return now_ns_;
  }

  void read(std::span<Feedback<S>> feedback) {
    auto f = feedback.begin();
    for (auto& plant : plants_) sample(plant, *f++);
  }

  void write(std::span<const Command<S>> command) {
    auto c = command.begin();
    for (auto& plant : plants_) {
      const auto& u = c->voltage;
      plant.command({machine::to_si(u[0]), machine::to_si(u[1]), machine::to_si(u[2])}, c->enable);
      ++c;
    }
  }

  // What the power stages and motors of the file's thermal and electrical values show; both channels of safe torque off
  // are closed.
  void read_protection(std::span<ProtectionInputs<S>> inputs) {
    for (std::size_t i = 0; i < plants_.size(); ++i) {
      supplies_[i].step(plants_[i].commanded(), plants_[i].current());
      inputs[i] = {};
      machine::convert(supplies_[i].dc_link(), inputs[i].dc_link);
      inputs[i].motor_temperature = tenths(supplies_[i].motor_temperature());
      inputs[i].stage_temperature = tenths(supplies_[i].stage_temperature());
    }
  }

  MotorSignalSet motor_signals(std::size_t) const {
    return {.dc_link = true, .motor_temperature = true, .stage_temperature = true, .torque_off = true};
  }

  // By the second encoder of an axis, where it sits on the load; asked for by whoever tunes a cam by it alone, since
  // its noise is drawn from the axis' own.
  LoadReading<S> read_load(std::size_t axis) {
    LoadReading<S> reading;
    if (const auto seen = plants_[axis].read_second_encoder())
      reading.valid = machine::convert(*seen, reading.position);
    return reading;
  }

  // Whether the brake of an axis is released; where the axis has none, nothing.
  void set_brake(std::size_t axis, bool released) { plants_[axis].set_brake(released); }

 private:
  static std::int16_t tenths(double celsius) { return static_cast<std::int16_t>(std::lround(10.0 * celsius)); }

  // Each of the two axes feels the other's mean acceleration of this tick in the next one.
  void advance_coupled() {
    const std::array before{plants_[0].velocity(), plants_[1].velocity()};
    const double per_tick = 1e9 / static_cast<double>(period_ns_);
    for (auto& plant : plants_) plant.advance_tick();
    for (std::size_t k = 0; k < 2; ++k)
      plants_[1 - k].set_other_acceleration((plants_[k].velocity() - before[k]) * per_tick);
  }

  // What cannot be represented (a plant that ran away to infinity or NaN) reaches the control as a position that is
  // not valid or as a fault input, never as a number.
  void sample(sim::AxisPlant& plant, Feedback<S>& f) const {
    f.position_valid = machine::convert({plant.read_encoder(), plant.encoder_velocity()}, f.position, f.velocity);
    f.position_time_ns = now_ns_;
    const auto& current = plant.current();
    f.fault = !machine::convert(current[0], f.current[0]);
    if (plant.phases() == 3 && !machine::convert({current[1], current[2]}, f.current[1], f.current[2])) f.fault = true;
  }

  std::int64_t period_ns_;
  std::int64_t now_ns_ = 0;
  bool started_ = false;
  bool coupled_ = false;  // whether an axis feels the other's acceleration
  std::vector<sim::AxisPlant> plants_;
  std::vector<sim::DriveSupply> supplies_;
};

}  // namespace stiction::hal
