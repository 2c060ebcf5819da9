// What a bus asks an axis for, and how long it counts (remote_axis.hpp): the values of a profile, held to the limits of
// the machine, and offsets that are as cyclic as targets are.
#pragma once

#include "stiction/motion/position_profile.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

// Holds until changed.
class AskedMove {
 public:
  using S = FixedSignals;

  // `fastest`: the limits, and what is asked for at first.
  explicit constexpr AskedMove(const PositionProfile::Move& fastest) : fastest_(fastest), move_(fastest) {}

  constexpr void target(S::Position target) { move_.target = target; }
  // Magnitudes, the last two a tick.
  constexpr void velocity(S::Velocity v) { move_.velocity = within(v, fastest_.velocity); }
  constexpr void acceleration(S::Velocity change) { move_.acceleration = within(change, fastest_.acceleration); }
  constexpr void deceleration(S::Velocity change) { move_.deceleration = within(change, fastest_.deceleration); }

  constexpr const PositionProfile::Move& move() const { return move_; }

 private:
  static constexpr S::Velocity within(S::Velocity asked, S::Velocity most) {
    return asked < S::Velocity::from_raw(1) ? S::Velocity::from_raw(1) : asked > most ? most : asked;
  }

  PositionProfile::Move fastest_, move_;
};

// Forgotten after as many cycles as targets may be missing.
template <int CyclesBridged>
class CyclicOffsets {
 public:
  using S = FixedSignals;

  constexpr void take(S::Velocity velocity, S::Current current) {
    velocity_ = velocity;
    current_ = current;
    age_ = 0;
  }
  constexpr void begin_cycle() {
    if (age_ <= CyclesBridged)
      ++age_;
    else
      *this = {};
  }

  constexpr S::Velocity velocity() const { return velocity_; }
  constexpr S::Current current() const { return current_; }

 private:
  S::Velocity velocity_{};
  S::Current current_{};
  int age_ = 0;  // cycles
};

}  // namespace stiction
