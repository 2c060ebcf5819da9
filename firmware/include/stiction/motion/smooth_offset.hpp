// An offset that goes to each new value with limited velocity, acceleration and jerk, of a motion that runs on below
// it: the phase of a master as a cam sees it, that of a slave behind a gear (PLCopen: MC_PhasingRelative), or a move
// that is superposed (MC_MoveSuperimposed). A new value takes the place of the one before, at any time.
//
// The length of a bridge is the first that keeps the limits; one is tried each tick, so that the work of a tick is
// fixed.
#pragma once

#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/motion/motion_point.hpp"

namespace stiction {

class SmoothOffset {
 public:
  // At rest at `value`, 2^-40 units.
  constexpr void start(std::int64_t value) {
    value_ = target_ = value;
    bridge_.clear();
    tried_ = none;
    refused_ = false;
  }

  // Goes to `target`, 2^-40 units, from where it is.
  constexpr void go(std::int64_t target) {
    target_ = target;
    tried_ = 0;
    refused_ = false;
  }

  // To standstill from wherever it is. `rule`: of its limits.
  constexpr void stop(const SpeedRampRule& rule) {
    tried_ = none;
    if (!bridge_.active()) return;
    const MotionPoint now = point();
    const Span span = Span::of(rule.ticks(now.velocity));
    value_ = target_ = now.position - bridge_.start_speed(span, now.velocity, now.acceleration);
  }

  // The offset of the coming tick, with a length tried in it; `limits`: of its motion.
  constexpr MotionPoint step(const MotionLimits& limits) {
    const MotionPoint now = advance();
    plan(limits);
    return now;
  }

  // The same of a tick that leaves the trying to a later one, and the trying within `limits` by itself, at the end of a
  // tick.
  constexpr MotionPoint advance() {
    bridge_.tick();
    return point();
  }
  constexpr void plan(const MotionLimits& limits) {
    if (!plans()) return;
    const MotionPoint now = point();
    const MotionPoint from{now.position - target_, now.velocity, now.acceleration};
    if (Bridge::fits(from, BridgeLengths::ticks(tried_), limits)) {
      bridge_.start(BridgeLengths::span(tried_), from, Bridge::Over::ticks);
      value_ = target_;
      tried_ = none;
    } else if (++tried_ == BridgeLengths::count) {
      // A bridge that still runs may be what leaves no room.
      tried_ = bridge_.active() ? std::int8_t{0} : none;
      refused_ = !bridge_.active();
    }
  }

  constexpr MotionPoint point() const {
    const MotionPoint deviation = bridge_.point();
    return {value_ + deviation.position, deviation.velocity, deviation.acceleration};
  }

  // Whether a length is to be tried.
  constexpr bool plans() const { return tried_ != none; }
  // Whether it is on its way, or about to be.
  constexpr bool busy() const { return bridge_.active() || plans(); }
  // Whether the last target was one that no length reaches within the limits. The offset then stays with the one
  // before.
  constexpr bool refused() const { return refused_; }

 private:
  static constexpr std::int8_t none = -1;

  std::int64_t value_ = 0, target_ = 0;  // 2^-40 units
  Bridge bridge_{};
  std::int8_t tried_ = none;  // number of the next length
  bool refused_ = false;
};

}  // namespace stiction
