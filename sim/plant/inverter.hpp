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
  // A tick has `steps_per_tick` steps of the plant of `step` s. In the step in which a dead time ends that is no whole
  // number of steps, the mean of the two voltages acts.
  InverterModel(const Inverter& inverter, double step, int steps_per_tick) : voltage_limit_(inverter.voltage_limit) {
    const double exact = inverter.dead_time / step;
    const bool whole = std::abs(exact - std::round(exact)) < 1e-6;
    const auto steps = static_cast<int>(whole ? std::lround(exact) : std::lround(std::floor(exact)));
    share_before_ = whole ? 1.0 : exact - steps;
    change_ = steps % steps_per_tick + (whole ? 0 : 1);
    last_ = static_cast<std::size_t>(steps / steps_per_tick) + 1;
    commands_.resize(last_ + 1);
  }

  // What the drive commands from this tick on.
  void command(const PhaseValues& voltage) {
    const auto limited = [limit = voltage_limit_](double u) { return std::clamp(u, -limit, limit); };
    command_ = {limited(voltage[0]), limited(voltage[1]), limited(voltage[2])};
  }

  // The voltages that act during one tick: `before` for the first `change` steps of the plant but the last of these,
  // where `between` acts, then `after`.
  struct Acting {
    const PhaseValues& before;
    const PhaseValues& between;
    const PhaseValues& after;
    int change;
  };
  Acting advance_tick() {
    commands_[newest_] = command_;
    newest_ = after(newest_);
    const std::size_t oldest = newest_;
    const std::size_t second = after(oldest);
    if (share_before_ == 1.0) [[likely]]
      return {commands_[oldest], commands_[oldest], commands_[second], change_};
    for (std::size_t k = 0; k < between_.size(); ++k)
      between_[k] = share_before_ * commands_[oldest][k] + (1.0 - share_before_) * commands_[second][k];
    return {commands_[oldest], between_, commands_[second], change_};
  }

  void switch_off() {
    command_ = {};
    std::fill(commands_.begin(), commands_.end(), PhaseValues{});
  }

 private:
  std::size_t after(std::size_t slot) const { return slot == last_ ? 0 : slot + 1; }

  double voltage_limit_;
  int change_;
  double share_before_;  // of the step in which the voltage changes
  PhaseValues between_{};
  PhaseValues command_{};
  std::vector<PhaseValues> commands_;  // ring, one a tick; the slot after the newest is the oldest
  std::size_t last_;                   // slot; size() of the vector is a division by the size of its elements
  std::size_t newest_ = 0;
};

}  // namespace stiction::sim
