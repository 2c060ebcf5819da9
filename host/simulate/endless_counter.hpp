// The phase of an endless axis in a simulated run, from the counts of its encoder.
#pragma once

#include <cstdint>

#include "firmware/machine/model/machine.hpp"
#include "stiction/motion/endless_phase.hpp"

namespace stiction::host {

class EndlessCounter {
 public:
  // Of an `axis`; at count 0 its phase is 0.
  explicit EndlessCounter(const machine::AxisModel& axis) {
    if (!axis.modulo_counts) return;
    config_ = EndlessPhase::config(axis.modulo_counts->numerator, axis.modulo_counts->denominator);
    counts_phase_ = true;
  }

  // Whether the axis is endless and has an encoder that counts.
  bool counts_phase() const { return counts_phase_; }

  // The encoder's reading, in counts from zero.
  void see(std::int64_t counts) {
    EndlessPhase::step(config_, state_, counts - seen_);
    seen_ = counts;
  }

  std::uint32_t phase() const { return EndlessPhase::phase(config_, state_); }  // 2^-32 turns

 private:
  EndlessPhase::Config config_;
  EndlessPhase::State state_;
  std::int64_t seen_ = 0;
  bool counts_phase_ = false;
};

// What a log shows for a whole turn of an endless axis: deg of a rotary one, else mm.
inline double shown_turn(const machine::AxisModel& axis) {
  if (!axis.exact_modulo) return 0.0;
  const auto& modulo = *axis.exact_modulo;
  const double unit = axis.coordinate.rotary() ? 360.0 : 1000.0;
  return unit * static_cast<double>(modulo.numerator) / static_cast<double>(modulo.denominator);
}

}  // namespace stiction::host
