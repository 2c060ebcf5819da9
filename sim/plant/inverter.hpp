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
  // number of steps, the mean of the two voltages acts. `inverter`: dead time and limits.
  InverterModel(const machine::InverterParameters& inverter, double step, int steps_per_tick)
      : voltage_limit_(inverter.voltage_limit) {
    const double exact = inverter.dead_time / step;
    const bool whole = std::abs(exact - std::round(exact)) < 1e-6;
    const auto steps = static_cast<int>(whole ? std::lround(exact) : std::lround(std::floor(exact)));
    share_before_ = whole ? 1.0 : exact - steps;
    change_ = steps % steps_per_tick + (whole ? 0 : 1);
    last_ = static_cast<std::size_t>(steps / steps_per_tick) + (changes_within_tick() ? 1 : 0);
    commands_.resize(last_ + 1);
  }

  // What the drive commands from this tick on.
  void command(const PhaseValues& voltage) { command_ = voltage; }
  const PhaseValues& commanded() const { return command_; }  // V

  // One tick. Of the voltages only those of the first `phases` are taken over.
  template <std::size_t phases>
  [[gnu::always_inline]] void advance_tick() {
    for (std::size_t k = 0; k < phases; ++k) commands_[oldest_][k] = limited(command_[k]);
    oldest_ = after(oldest_);
  }

  // Whether the voltage that acts changes within a tick; if not, it is `voltage`.
  bool changes_within_tick() const { return change_ != 0; }
  template <std::size_t phases>
  PhaseValues voltage() const {
    PhaseValues first{};
    for (std::size_t k = 0; k < phases; ++k) first[k] = commands_[oldest_][k];
    return first;
  }

  // The voltages that act during the tick: `before` for the first `change` steps of the plant but the last of these,
  // where `between` acts, then `after`.
  struct Acting {
    const PhaseValues& before;
    PhaseValues between;
    const PhaseValues& after;
    int change;
  };
  Acting acting() const {
    const std::size_t second = changes_within_tick() ? after(oldest_) : oldest_;
    PhaseValues between;
    for (std::size_t k = 0; k < between.size(); ++k)
      between[k] = share_before_ == 1.0
                       ? commands_[oldest_][k]
                       : share_before_ * commands_[oldest_][k] + (1.0 - share_before_) * commands_[second][k];
    return {commands_[oldest_], between, commands_[second], change_};
  }

  double voltage_limit() const { return voltage_limit_; }    // V
  int change() const { return change_; }                     // steps, as in Acting
  double share_before() const { return share_before_; }      // of the step in which the voltage changes
  std::size_t commands() const { return commands_.size(); }  // that are on their way

  void switch_off() {
    command_ = {};
    std::fill(commands_.begin(), commands_.end(), PhaseValues{});
  }

 private:
  // std::clamp gives a reference, for which the compiler takes branches.
  double limited(double voltage) const {
    const double above = voltage < -voltage_limit_ ? -voltage_limit_ : voltage;
    return above > voltage_limit_ ? voltage_limit_ : above;
  }
  std::size_t after(std::size_t slot) const { return slot == last_ ? 0 : slot + 1; }

  double voltage_limit_;
  int change_;
  double share_before_;  // of the step in which the voltage changes
  PhaseValues command_{};
  std::vector<PhaseValues> commands_;  // ring, one a tick: those that act in this one and what comes after them
  std::size_t last_;                   // slot; size() of the vector is a division by the size of its elements
  std::size_t oldest_ = 0;             // slot
};

}  // namespace stiction::sim
