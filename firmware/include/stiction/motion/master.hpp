// A virtual master: a line shaft that no machine part turns. Its speed goes to a new one with limited acceleration and
// jerk; at a constant speed its phase goes on by the same whole number each tick, so that nothing is rounded however
// long it runs. It stops at once or at an angle, and jogs: run() while the button is held, run(0) when it is not.
//
// A change of speed is a uniform motion at the new speed, and a bridge to it from the one before (bridge.hpp).
#pragma once

#include <cstdint>

#include "stiction/motion/bridge.hpp"
#include "stiction/motion/endless_phase.hpp"
#include "stiction/motion/master_position.hpp"

namespace stiction {

class VirtualMaster {
 public:
  struct Config {
    MotionLimits limits{};  // in cycles
    SpeedRampRule rule{};

    // Keeps `limits`, in cycles: a velocity of up to half a cycle a tick, an acceleration and a jerk above 0.
    static constexpr Config of(const MotionLimits& limits) { return {limits, SpeedRampRule::of(limits)}; }
  };

  explicit constexpr VirtualMaster(const Config& config) : config_(config) {}

  // Stands at `position`.
  constexpr void start(const MasterPosition& position) {
    base_ = position;
    speed_ = 0;
    bridge_.clear();
    stopping_ = false;
  }

  // Goes to `speed`, in 2^-64 cycles a tick, of either sign. False, and nothing changes, where it is beyond the limit.
  constexpr bool run(std::int64_t speed) {
    if (magnitude(speed) > static_cast<std::uint64_t>(config_.limits.velocity) << MotionPoint::tick_bits) return false;
    stopping_ = false;
    const MasterPoint now = point();
    const std::int64_t difference = now.velocity - (speed >> MotionPoint::tick_bits);
    const Span span = Span::of(config_.rule.ticks(difference));
    base_ = now.position + MasterPosition::way(-bridge_.start_speed(span, difference, now.acceleration));
    speed_ = speed;
    return true;
  }

  // Takes up the motion `now` of a master, and brakes it to standstill in `ticks`, whatever the limits are.
  constexpr void brake_from(const MasterPoint& now, std::int64_t ticks) {
    const Span span = Span::of(ticks);
    base_ = now.position + MasterPosition::way(-bridge_.start_speed(span, now.velocity, now.acceleration));
    speed_ = 0;
    stopping_ = false;
  }

  // Stops at the next `angle` that it can, in 2^-64 cycles, once it runs at a constant speed; in the direction that it
  // has. One that stands stays.
  constexpr void stop_at(std::uint64_t angle) {
    stopping_ = true;
    angle_ = angle;
  }

  // The master of the coming tick.
  constexpr MasterPoint step() {
    base_ = base_ + MasterPosition::fine(speed_);
    bridge_.tick();
    if (stopping_ && !bridge_.active()) begin_stop();
    return point();
  }

  constexpr MasterPoint point() const {
    const MotionPoint deviation = bridge_.point();
    return {base_ + MasterPosition::way(deviation.position), (speed_ >> MotionPoint::tick_bits) + deviation.velocity,
            deviation.acceleration};
  }

  // Whether its speed is the one asked for.
  constexpr bool at_speed() const { return !bridge_.active() && !stopping_; }

 private:
  // The bridge of a stop takes about half of what its ticks take at speed; it begins in the tick from which the angle
  // is at least so far ahead, and less than a tick's way more.
  constexpr void begin_stop() {
    const std::uint64_t speed = magnitude(speed_);
    if (speed == 0) {
      stopping_ = false;
      return;
    }
    const bool back = speed_ < 0;
    const Span span = Span::of(config_.rule.ticks(speed_ >> MotionPoint::tick_bits));
    const auto ticks = static_cast<std::uint64_t>(span.length);
    const std::uint64_t ahead = back ? base_.phase - angle_ : angle_ - base_.phase;
    const std::uint64_t excess = ahead - (speed >> 1) * ticks;
    if (excess >= speed) return;
    const std::int64_t way = product_shifted(static_cast<std::int64_t>(speed >> 1), span.length, 24) +
                             static_cast<std::int64_t>(excess >> 24);
    MasterPosition target = base_ + MasterPosition::way(back ? -way : way);
    target = target + MasterPosition::fine(static_cast<std::int64_t>(angle_ - target.phase));
    bridge_.start(span, {(base_ - target).raw(), speed_ >> MotionPoint::tick_bits, 0}, Bridge::Over::ticks);
    base_ = target;
    speed_ = 0;
    stopping_ = false;
  }

  Config config_;
  MasterPosition base_{};    // of the uniform motion
  std::int64_t speed_ = 0;   // its speed, 2^-64 cycles a tick
  Bridge bridge_{};          // to it
  std::uint64_t angle_ = 0;  // at which to stop
  bool stopping_ = false;
};

// The place of an endless axis, or of an encoder's counts, as that of a master whose cycle is its turn, to 2^-32 of it.
// `config`, `state`: of the axis.
constexpr MasterPosition master_position(const EndlessPhase::Config& config, const EndlessPhase::State& state) {
  return {state.turns, std::uint64_t{EndlessPhase::phase(config, state)} << 32};
}

}  // namespace stiction
