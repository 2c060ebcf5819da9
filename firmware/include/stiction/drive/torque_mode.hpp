// Cyclic synchronous torque (CiA 402, mode 10): a current that others ask for, held to what keeps the axis within its
// speed and within the ends of its travel.
//
// The current goes to the one asked for by torque_slope (6087h). It is held between two others, each a proportional
// velocity controller of its own with the gain of the axis: v_high is the speed that the axis may have in +x where it
// is, v_low the one in -x,
//   gain (v_low - v) <= i <= gain (v_high - v),
// so that nothing switches between laws: far from both speeds the current is the one asked for. Up to an end the speed
// is the least of 6080h and the one from which d a tick still brakes, down to one that is proportional to the way R
// left (in ticks of speed), with the slope k a tick, so that both and their slopes agree at R = d / k^2:
//   v = k R  for R <= d / k^2,  v = sqrt(2 d R - (d / k)^2) beyond.
// At the end both laws are a position controller that pushes back what pushes the axis out. Beyond an end the place to
// hold is where the axis is, and goes in with it: it may go back, and no further out. The braking d is at most half of
// what the largest current makes of the mass: the other half is friction's and the controller's.
// Without a zero there are no ends. Fixed work: two square roots a tick.
#pragma once

#include <cstdint>

#include "stiction/control/limit.hpp"
#include "stiction/motion/ticks_of_speed.hpp"
#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "stiction/number/square_root.hpp"

namespace stiction {

class TorqueMode {
 public:
  using S = FixedSignals;
  using SpeedOfCurrent = Coefficient<24>;  // change of the speed in a tick by a current, m/s per A, below 64

  struct Config {
    S::Current most{};           // of the axis: 1000 thousandths of torque
    S::Current slope{};          // change of the current in a tick, above 0
    S::Velocity speed{};         // 6080h
    S::Velocity deceleration{};  // change of the speed in a tick before an end
    SpeedOfCurrent speed_of_current{};
    S::VelocityGain gain{};     // A s/m
    int stiffness_bits = 9;     // k = 2^-stiffness_bits a tick
    S::Position low{}, high{};  // the ends of the travel
    S::Rate rate{};             // 1 / tick
  };
  // What the axis is doing, the machine's coordinates.
  struct Seen {
    S::Position position{};
    S::Velocity velocity{};
    bool referenced = false;
  };

  explicit constexpr TorqueMode(const Config& config) : config_(config) { limit_to(config.most); }

  // 6072h, of all modes; above 0.
  constexpr void limit_to(S::Current most) {
    most_ = most > config_.most ? config_.most : most < S::Current::from_raw(1) ? S::Current::from_raw(1) : most;
    const auto makes = narrow<S::Velocity>(most_ * config_.speed_of_current, saturations_);
    const std::int64_t half = makes.raw() >> 1, wanted = config_.deceleration.raw();
    braking_ = half < 1 ? 1 : half < wanted ? half : wanted;
    const auto v = static_cast<std::uint64_t>(config_.speed.raw());
    far_ = (v * v + square_of_join()) / (2 * static_cast<std::uint64_t>(braking_));
  }
  constexpr S::Current most() const { return most_; }
  constexpr bool is_limited() const { return most_ < config_.most; }

  // The axis is led by someone else, with `current`.
  constexpr void start(S::Current current, S::Position position) {
    current_ = clamped(current, most_);
    held_low_ = position < config_.low ? position : config_.low;
    held_high_ = position > config_.high ? position : config_.high;
    held_back_ = false;
  }

  // The current of the coming tick. `target`: 6071h.
  constexpr S::Current step(S::Current target, const Seen& seen) {
    const auto missing = saturated_difference(clamped(target, most_), current_, saturations_);
    current_ = clamped(saturated_sum(current_, clamped(missing, config_.slope), saturations_), most_);
    if (seen.position > held_low_) held_low_ = seen.position < config_.low ? seen.position : config_.low;
    if (seen.position < held_high_) held_high_ = seen.position > config_.high ? seen.position : config_.high;
    auto up = config_.speed, down = config_.speed;
    if (seen.referenced) {
      up = speed_before(held_high_.raw() - seen.position.raw());
      down = speed_before(seen.position.raw() - held_low_.raw());
    }
    const auto high = towards(up, seen.velocity), low = towards(opposite(down), seen.velocity);
    const auto i = current_ > high ? high : current_ < low ? low : current_;
    held_back_ = i != current_ || exceeds(target, most_);
    return i;
  }

  // Whether the current of the last tick is not the one asked for: by speed, end or 6072h.
  constexpr bool held_back() const { return held_back_; }

 private:
  // (d / k)^2, the square of the speed at which both laws join.
  constexpr std::uint64_t square_of_join() const {
    const auto v = static_cast<std::uint64_t>(braking_ << config_.stiffness_bits);
    return v * v;
  }

  // Of the way left to an end, 2^-40 m; behind it the speed back.
  constexpr S::Velocity speed_before(std::int64_t left) const {
    constexpr std::int64_t most_way = std::int64_t{1} << 46;  // 64 m
    const bool beyond = left < 0;
    const std::int64_t way = beyond ? -left : left;
    const auto speeds = ticks_of_speed(static_cast<std::uint64_t>(way < most_way ? way : most_way), config_.rate);
    if (speeds >= far_) return beyond ? opposite(config_.speed) : config_.speed;
    const std::uint64_t proportional = speeds >> config_.stiffness_bits;
    const auto d = static_cast<std::uint64_t>(braking_);
    const bool near = proportional <= d << config_.stiffness_bits;
    const std::uint64_t v = near ? proportional : square_root(2 * d * speeds - square_of_join());
    const auto most = static_cast<std::uint64_t>(config_.speed.raw());
    const auto speed = S::Velocity::from_bounded_raw(static_cast<std::int64_t>(v < most ? v : most));
    return beyond ? opposite(speed) : speed;
  }

  constexpr S::Current towards(S::Velocity speed, S::Velocity v) {
    return clamped(narrow<S::Current>(config_.gain * saturated_difference(speed, v, saturations_), saturations_),
                   most_);
  }

  Config config_;
  S::Current most_{}, current_{};
  std::int64_t braking_ = 1;  // d
  std::uint64_t far_ = 0;     // ticks of speed, from which on an end does not matter
  S::Position held_low_{}, held_high_{};
  bool held_back_ = false;
  SaturationCounter saturations_;
};

}  // namespace stiction
