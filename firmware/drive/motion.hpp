// Motions that the programme can run by itself, for trying an axis out: set-points computed before the loop starts, so
// that the loop has nothing to compute in floating point and nothing to wait for.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "sim/model/machine.hpp"
#include "stiction/drive/exchange.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::drive {

// A motion that the machine cannot make. what() says what was found and what was expected.
class MotionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Motion {
 public:
  using Set = SetPoint<FixedSignals>;

  // The circle test at `feed` (m/s), two turns at rest at the start: the same set-points as `stiction simulate circle`.
  // Throws MotionError.
  static Motion circle(const sim::Machine& machine, double feed);

  // Every axis stays where it is at the start (m) for a time (s).
  static Motion hold(const sim::Machine& machine, std::span<const double> positions, double duration);

  std::size_t ticks() const { return sets_.size() / axes_; }
  std::span<const Set> at(std::size_t tick) const { return {sets_.data() + tick * axes_, axes_}; }

 private:
  explicit Motion(std::size_t axes) : axes_(axes) {}

  std::size_t axes_;
  std::vector<Set> sets_;  // tick by tick, all axes
};

}  // namespace stiction::drive
