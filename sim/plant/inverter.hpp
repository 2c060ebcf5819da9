// Inverter: the commanded voltages reach the motor after the dead time of the pulse-width modulation (Mendricky 2006,
// 3.2.2.1) and are held in between; the DC link limits them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/plant/motor.hpp"

namespace stiction::sim {

class InverterModel {
 public:
  // A tick has `steps_per_tick` steps of the plant of `step` s; the dead time is a whole number of steps.
  InverterModel(const Inverter& inverter, double step, int steps_per_tick) : voltage_limit_(inverter.voltage_limit) {
    const auto steps = static_cast<int>(std::lround(inverter.dead_time / step));
    change_ = steps % steps_per_tick;
    last_ = static_cast<std::size_t>(steps / steps_per_tick) + 1;
    commands_.resize(last_ + 1);
  }

  // What the drive commands from this tick on.
  void command(const PhaseValues& voltage) {
    const auto limited = [limit = voltage_limit_](double u) { return std::clamp(u, -limit, limit); };
    command_ = {limited(voltage[0]), limited(voltage[1]), limited(voltage[2])};
  }

  // The voltages that act during one tick: `before` for the first `change` steps of the plant, then `after`.
  struct Acting {
    const PhaseValues& before;
    const PhaseValues& after;
    int change;
  };
  Acting advance_tick() {
    commands_[newest_] = command_;
    newest_ = after(newest_);
    const std::size_t oldest = newest_;
    const std::size_t second = after(oldest);
    return {commands_[oldest], commands_[second], change_};
  }

  void switch_off() {
    command_ = {};
    std::fill(commands_.begin(), commands_.end(), PhaseValues{});
  }

 private:
  std::size_t after(std::size_t slot) const { return slot == last_ ? 0 : slot + 1; }

  double voltage_limit_;
  int change_;
  PhaseValues command_{};
  std::vector<PhaseValues> commands_;  // ring, one a tick; the slot after the newest is the oldest
  std::size_t last_;                   // slot; size() of the vector is a division by the size of its elements
  std::size_t newest_ = 0;
};

}  // namespace stiction::sim
