// A move to a target position by itself (pp: CiA 402 profile position), a set-point each tick, targets and limits new
// at any time. Two stages:
//
// 1. A trapezoid of velocity that looks where it is in every tick: the speed towards the target is the least of the one
//    before plus the acceleration, the profile's velocity, and the one from which it can still brake. Braking by d a
//    tick from speed y, and one tick's way of it left at its end, takes the way y (y + d) / (2 d) in ticks of speed; so
//      y = sqrt(2 d R + d^2 / 4) - d / 2
//    for what is left, R, and after a tick at that speed it is y - d. The last tick goes to the target exactly, up to
//    d / 8 slower than the one before minus d, which the second stage hides from k = 3 on. Braking is planned with a
//    64th less than allowed: without that reserve a unit of rounding early on is 50 nm at the end.
// 2. The mean over the last 2^k ticks bounds the jerk, to (acceleration + deceleration) / (2^k ticks) where one follows
//    on the other and to one of them elsewhere, and takes 2^k - 1 ticks longer;
//    velocity and acceleration are means of those of the trapezoid and keep its limits (the chain of moving averages of
//    L. Biagiotti, C. Melchiorri, "FIR filters for online trajectory planning with time- and frequency-domain
//    specifications", Control Engineering Practice 20, 2012).
//
// Fixed work, but for one 64-bit division when a move begins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "stiction/motion/ticks_of_speed.hpp"
#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "stiction/number/square_root.hpp"

namespace stiction {

class PositionProfile {
 public:
  using S = FixedSignals;
  static constexpr int most_smoothing_bits = 10;
  static constexpr int exact_smoothing_bits = 3;  // from which on a braking keeps its deceleration to its last tick

  struct Config {
    S::Seconds period{};
    S::Rate rate{};          // 1 / period
    int smoothing_bits = 0;  // k, 0 to most_smoothing_bits
  };
  // All magnitudes; the changes of velocity are those of a tick and at least one unit.
  struct Move {
    S::Position target{};
    S::Velocity velocity{};
    S::Velocity acceleration{};
    S::Velocity deceleration{};
    bool operator==(const Move&) const = default;
  };
  struct Point {
    S::Position position{};
    S::Velocity velocity{};
    S::Acceleration acceleration{};
  };

  explicit constexpr PositionProfile(const Config& config) : config_(config) {}

  // Stands at `position`, with nothing to do. Positions must stay within 128 m of it. `smoothed`: with the second
  // stage.
  constexpr void start(S::Position position, bool smoothed = true) {
    smoothing_bits_ = smoothed ? config_.smoothing_bits : 0;
    base_ = position;
    move_ = {position, {}, {}, {}};
    way_ = 0;
    v_ = 0;
    way_sum_ = v_sum_ = 0;
    filled_ = place_ = 0;
    resting_ticks_ = length();
    one_braking_ = 0;
  }

  constexpr void go(const Move& move) {
    move_ = move;
    const auto v = static_cast<std::uint64_t>(move.velocity.raw());
    const auto allowed = static_cast<std::uint64_t>(move.deceleration.raw());
    braking_ = allowed > 1 ? allowed - (allowed >> 6) - 1 : 1;
    one_braking_ = v * (v + braking_) / (2 * braking_);
    resting_ticks_ = 0;
  }

  // The set-point of the coming tick. `halted`: it brakes and stands, and goes on to the target afterwards;
  // `halting`: change of the speed in a tick by which it then brakes where that is more than the move's own.
  constexpr Point step(bool halted, S::Velocity halting = {}) {
    if (move_.velocity > S::Velocity{}) advance(halted, halting);
    resting_ticks_ = v_ != 0 ? 0 : resting_ticks_ < length() ? resting_ticks_ + 1 : length();
    return smooth();
  }

  constexpr const Move& move() const { return move_; }
  constexpr bool keeps_deceleration() const { return smoothing_bits_ >= exact_smoothing_bits; }
  constexpr S::Position base() const { return base_; }  // where it started
  constexpr bool at_rest() const { return resting_ticks_ == length(); }
  constexpr bool arrived() const { return at_rest() && way_ == way_to_target(); }

 private:
  constexpr std::uint32_t length() const { return 1u << smoothing_bits_; }
  constexpr std::int64_t way_to_target() const { return move_.target.raw() - base_.raw(); }

  constexpr void advance(bool halted, S::Velocity halting) {
    const std::int64_t left = way_to_target() - way_;
    const bool back = left < 0;
    const std::int64_t towards = back ? -v_ : v_;
    const std::int64_t up = move_.acceleration.raw(), down = move_.deceleration.raw();
    if (halted) {
      run(braked(v_, halting.raw() > down ? halting.raw() : down));
    } else if (towards < 0) {
      run(braked(v_, down));
    } else {
      const auto way = static_cast<std::uint64_t>(back ? -left : left);
      const auto speeds = ticks_of_speed(way, config_.rate);
      const std::int64_t fastest = least(least(towards + up, move_.velocity.raw()), braking_speed(speeds));
      const auto last = static_cast<std::int64_t>(speeds);
      // At the end of a braking the last speed is up to an eighth more than d below the one before.
      if (last <= down && last <= towards + up && towards - last <= down + (down >> 2)) {
        v_ = back ? -last : last;
        way_ += left;
      } else {
        const std::int64_t speed = fastest < towards - down ? towards - down : fastest;
        run(back ? -speed : speed);
      }
    }
  }

  constexpr void run(std::int64_t v) {
    v_ = v;
    const auto step = S::Velocity::from_bounded_raw(v) * config_.period;
    way_ += narrow<Wide<40, std::uint64_t{1} << 38>>(step, saturations_).raw();
  }

  static constexpr std::int64_t braked(std::int64_t v, std::int64_t change) {
    if (v > 0) return v > change ? v - change : 0;
    return v < -change ? v + change : 0;
  }
  static constexpr std::int64_t least(std::int64_t a, std::int64_t b) { return a < b ? a : b; }

  constexpr std::int64_t braking_speed(std::uint64_t speeds) const {
    if (speeds >= one_braking_) return move_.velocity.raw();
    const std::uint64_t d = braking_;
    return static_cast<std::int64_t>(square_root(2 * d * speeds + d * d / 4) - d / 2);
  }
  constexpr Point smooth() {
    // Before the buffer is full, what leaves it is the standstill before.
    const bool full = filled_ == length();
    const Entry gone = full ? entries_[place_] : Entry{};
    entries_[place_] = {way_, v_};
    place_ = (place_ + 1) & (length() - 1);
    if (!full) ++filled_;
    way_sum_ += way_ - gone.way;
    v_sum_ += v_ - gone.v;
    const std::int64_t change = v_ - gone.v;  // over all of the window
    const auto mean_change = S::Velocity::from_bounded_raw(shifted(change));
    const std::int64_t rest = change - (static_cast<std::int64_t>(mean_change.raw()) << smoothing_bits_);
    Point point;
    point.position = S::Position::from_raw(base_.raw() + shifted(way_sum_));
    point.velocity = S::Velocity::from_bounded_raw(shifted(v_sum_));
    // Its change in a tick may be far below a unit of velocity: what the shift left over counts too.
    const auto fine = narrow<Wide<32, std::uint64_t{1} << 37>>(mean_change * config_.rate, saturations_);
    const auto remainder = S::Velocity::from_bounded_raw(rest) * config_.rate;
    point.acceleration = narrow<S::Acceleration>(
        fine + Wide<32, std::uint64_t{1} << 37>::from_raw(remainder.raw() >> (6 + smoothing_bits_)), saturations_);
    return point;
  }
  // To the nearest, ties away from zero.
  constexpr std::int64_t shifted(std::int64_t sum) const {
    if (smoothing_bits_ == 0) return sum;
    const std::int64_t half = std::int64_t{1} << (smoothing_bits_ - 1);
    return (sum + half - (sum < 0 ? 1 : 0)) >> smoothing_bits_;
  }

  struct Entry {
    std::int64_t way = 0, v = 0;
  };

  Config config_;
  int smoothing_bits_ = 0;  // of config_, or 0
  S::Position base_{};
  Move move_{};
  std::uint64_t braking_ = 1;      // deceleration that is planned with, 2^-28 m/s a tick
  std::uint64_t one_braking_ = 0;  // from the profile's velocity to rest, in ticks of speed
  std::int64_t way_ = 0;           // of the trapezoid from base_, 2^-40 m
  std::int64_t v_ = 0;             // its velocity, 2^-28 m/s
  std::int64_t way_sum_ = 0, v_sum_ = 0;
  std::uint32_t filled_ = 0, place_ = 0, resting_ticks_ = 0;
  std::array<Entry, std::size_t{1} << most_smoothing_bits> entries_{};
  SaturationCounter saturations_;
};

}  // namespace stiction
