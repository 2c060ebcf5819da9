// Which faults a simulated machine has at a tick: those that were named, at the time that was named, or one of them at
// a time, again and again, at random times.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "host/plant/plant_fault.hpp"

namespace stiction::host {

class FaultSchedule {
 public:
  explicit FaultSchedule(std::vector<PlantFault> faults) : faults_(std::move(faults)) {}

  // One of `faults` at a time, whatever their from_tick; from the begin of one to that of the next it takes
  // `mean_ticks` in the mean: a quarter of it at least, in which the drive can get over it, and then as long as a
  // Poisson process. `seed`: of the times and of the choice.
  FaultSchedule(std::vector<PlantFault> faults, double mean_ticks, std::uint64_t seed)
      : choice_(std::move(faults)), mean_ticks_(mean_ticks), random_(seed), faults_(1) {
    draw(0);
  }

  static constexpr double quiet_share = 0.25;

  // Before tick `tick` is asked for; ticks one after the other.
  void advance(std::uint64_t tick) {
    // An answer that was kept back comes a tick after the fault.
    if (!choice_.empty() && tick > faults_[0].from_tick + faults_[0].ticks + 1) draw(faults_[0].from_tick);
  }

  // To be asked whether they act.
  std::span<const PlantFault> faults() const { return faults_; }

  // The parts and signals of every axis as they are in a tick. `faults_of(axis)`, `signals_of(axis)`: the
  // hal::AxisFaults and hal::MotorSignals of an axis.
  template <class FaultsOf, class SignalsOf>
  void break_parts(std::uint64_t tick, FaultsOf faults_of, SignalsOf signals_of) const {
    for (const bool acts : {false, true})  // two faults may be of one part
      for (const auto& fault : faults_) {
        if (fault.acts(tick) != acts) continue;
        if (fault.kind->machine != nullptr) fault.kind->machine(faults_of(fault.axis), acts);
        if (fault.kind->signal != nullptr) fault.kind->signal(signals_of(fault.axis), acts);
      }
  }

  // Whether a fault whose `member` (frame or line) is `kind` acts on `axis` in `tick`.
  template <class Kind>
  bool acts(Kind PlantFaultKind::*member, Kind kind, std::size_t axis, std::uint64_t tick) const {
    return std::any_of(faults_.begin(), faults_.end(), [&](const PlantFault& fault) {
      return fault.kind->*member == kind && fault.axis == axis && fault.acts(tick);
    });
  }

 private:
  void draw(std::uint64_t since) {
    const double random_part = std::exponential_distribution<double>(1.0 / (1.0 - quiet_share))(random_);
    faults_[0] = choice_[std::uniform_int_distribution<std::size_t>(0, choice_.size() - 1)(random_)];
    faults_[0].from_tick = since + static_cast<std::uint64_t>(mean_ticks_ * (quiet_share + random_part));
  }

  std::vector<PlantFault> choice_;
  double mean_ticks_ = 0.0;  // 0: not at random
  std::mt19937_64 random_;
  std::vector<PlantFault> faults_;
};

}  // namespace stiction::host
