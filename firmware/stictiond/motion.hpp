// Motions that the programme can run by itself, for trying a machine out: set-points computed before the loop starts,
// so that the loop has nothing to compute in floating point and nothing to wait for.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "firmware/machine/model/machine.hpp"
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

  explicit Motion(std::size_t axes) : axes_(axes) {}

  // The circle test at `feed` (m/s): a start at rest and two turns, the set-points of `stiction simulate circle`.
  // Throws MotionError.
  static Motion circle(const machine::Machine& machine, double feed);

  // No set-points of its own, but a begin at `positions` (m, one an axis).
  static Motion standing_at(std::span<const double> positions) {
    Motion motion(positions.size());
    motion.start_.assign(positions.begin(), positions.end());
    return motion;
  }

  // From `positions` (m, one an axis) to where this motion begins, all axes at once, slowly and from rest to rest; none
  // where they stand there already. Whole slow periods, so that what comes after begins with one.
  Motion approach(const machine::Machine& machine, std::span<const double> positions) const;

  std::size_t ticks() const { return sets_.size() / axes_; }
  std::span<const Set> at(std::size_t tick) const { return {sets_.data() + tick * axes_, axes_}; }
  const std::vector<double>& start() const { return start_; }  // m, one an axis; not rounded to the drive's format

 private:
  std::size_t axes_;
  std::vector<double> start_;
  std::vector<Set> sets_;  // tick by tick, all axes
};

}  // namespace stiction::drive
