// Inverter: the commanded voltages reach the motor after the dead time of the pulse-width modulation (Mendricky 2006,
// 3.2.2.1) and are held in between; the DC link limits them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/plant/motor.hpp"

namespace stiction::sim {

class InverterModel {
 public:
  // `step`: the plant's step; the dead time is a whole number of them.
  InverterModel(const Inverter& inverter, double step)
      : voltage_limit_(inverter.voltage_limit),
        line_(static_cast<std::size_t>(std::lround(inverter.dead_time / step)) + 1) {}

  void command(const PhaseValues& voltage) {
    for (std::size_t k = 0; k < 3; ++k) command_[k] = std::clamp(voltage[k], -voltage_limit_, voltage_limit_);
  }

  // The voltages (V) that act during the next step.
  const PhaseValues& advance() {
    line_[newest_] = command_;
    newest_ = newest_ + 1 == line_.size() ? 0 : newest_ + 1;
    return line_[newest_];
  }

  void switch_off() {
    command_ = {};
    std::fill(line_.begin(), line_.end(), PhaseValues{});
  }

 private:
  double voltage_limit_;
  PhaseValues command_{};
  std::vector<PhaseValues> line_;  // ring: the slot after the newest is the oldest
  std::size_t newest_ = 0;
};

}  // namespace stiction::sim
