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
    commands_.resize(static_cast<std::size_t>(steps / steps_per_tick) + 2);
  }

  // What the drive commands from this tick on.
  void command(const PhaseValues& voltage) {
    for (std::size_t k = 0; k < 3; ++k) command_[k] = std::clamp(voltage[k], -voltage_limit_, voltage_limit_);
  }

  // The voltages that act during one tick: `before` for the first `change` steps of the plant, then `after`.
  struct Acting {
    const PhaseValues& before;
    const PhaseValues& after;
    int change;
  };
  Acting advance_tick() {
    commands_[newest_] = command_;
    newest_ = newest_ + 1 == commands_.size() ? 0 : newest_ + 1;
    const std::size_t oldest = newest_;
    const std::size_t second = oldest + 1 == commands_.size() ? 0 : oldest + 1;
    return {commands_[oldest], commands_[second], change_};
  }

  void switch_off() {
    command_ = {};
    std::fill(commands_.begin(), commands_.end(), PhaseValues{});
  }

 private:
  double voltage_limit_;
  int change_;
  PhaseValues command_{};
  std::vector<PhaseValues> commands_;  // ring, one a tick; the slot after the newest is the oldest
  std::size_t newest_ = 0;
};

}  // namespace stiction::sim
