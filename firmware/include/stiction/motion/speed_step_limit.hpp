// Holds the change of a set speed in a tick to a limit, whatever a source of set-points asks for: a motion controller's
// targets (set_point_interpolator.hpp) may be those of no motion that the machine can make.
//
// A set-point within the limit, and where its own speed leads, passes through as it is. Any other one is followed at
// the limit, from then on beside the source, until the way between both is made up: with what the source's own change
// leaves of the limit, d a tick, on the curve from which a relative speed u can still be taken back. From u to u' in
// this tick and by d a tick behind it the way is, in ticks of speed, R = (u + u') / 2 + u'^2 / (2 d), so that
//   u' = sqrt(d^2 / 4 + 2 d R - d u) - d / 2.
// Both join where one tick does it: within the limit, and with a position that is off by at most a quarter of what the
// limit makes of it in a tick (20 nm at 20 m/s^2 and 62.5 us).
//
// Fixed work, but for a square root in the ticks beside the source.
#pragma once

#include <cstdint>

#include "stiction/motion/ticks_of_speed.hpp"
#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"
#include "stiction/number/square_root.hpp"

namespace stiction {

class SpeedStepLimit {
 public:
  using S = FixedSignals;

  struct Config {
    S::Velocity change{};  // of the speed in a tick, above 0
    S::Seconds half_period{};
    S::Rate rate{};             // 1 / period
    S::Position largest_lag{};  // from the source, beyond which no set-point of the source is to be followed any more
  };
  struct Point {
    S::Position position{};
    S::Velocity velocity{};
    S::Acceleration acceleration{};
  };

  explicit constexpr SpeedStepLimit(const Config& config) : config_(config) {}

  // Both stand at `position`.
  constexpr void start(S::Position position) {
    source_ = point_ = {position, {}, {}};
    beside_ = false;
  }

  // The set-point of a tick: `source`, or what the limit leaves of it. Speeds within half of their format.
  constexpr Point step(const Point& source) {
    const std::int64_t before = point_.velocity.raw(), most = config_.change.raw();
    const std::int64_t missing = source.velocity.raw() - before;
    const bool within = missing <= most && missing >= -most;
    if (within && joins(source)) {
      beside_ = false;
      source_ = point_ = source;
      return point_;
    }
    beside_ = true;
    const std::int64_t of_source = source.velocity.raw() - source_.velocity.raw();
    const std::int64_t left = most - (of_source < 0 ? -of_source : of_source), least = (most >> 3) + 1;
    const std::int64_t wanted = source.velocity.raw() + catching_up(left > least ? left : least);
    const std::int64_t change = wanted - before;
    run(S::Velocity::from_bounded_raw(change > most ? most : change < -most ? -most : change));
    source_ = source;
    return point_;
  }

  // Whether the source is followed, if late; false: it left by more than largest_lag.
  constexpr bool follows() const {
    const std::int64_t lag = source_.position.raw() - point_.position.raw(), most = config_.largest_lag.raw();
    return lag <= most && lag >= -most;
  }

 private:
  using Way = Wide<40, std::uint64_t{1} << 38>;  // in half a tick

  // Of half a tick.
  constexpr std::int64_t half_way(S::Velocity speed) {
    return narrow<Way>(speed * config_.half_period, saturations_).raw();
  }
  constexpr void run(S::Velocity change) {
    const auto now = saturated_sum(point_.velocity, change, saturations_);
    const auto position = point_.position.raw() + half_way(point_.velocity) + half_way(now);
    point_ = {S::Position::from_raw(position), now, narrow<S::Acceleration>(change * config_.rate, saturations_)};
  }

  constexpr bool joins(const Point& source) {
    const std::int64_t after = point_.position.raw() + half_way(point_.velocity) + half_way(source.velocity);
    const std::int64_t off = source.position.raw() - after, most = half_way(config_.change) >> 1;
    return off <= most && off >= -most;
  }

  // Relative to the source: the speed of this tick that brings both together, with `d` to take it back.
  constexpr std::int64_t catching_up(std::int64_t d) const {
    constexpr std::int64_t most_way = std::int64_t{1} << 36;  // 62 mm; 2 d R stays within 63 bits
    const std::int64_t lag = source_.position.raw() - point_.position.raw();
    const bool back = lag < 0;
    const std::int64_t way = back ? -lag : lag;
    const auto held = static_cast<std::uint64_t>(way < most_way ? way : most_way);
    const auto left = static_cast<std::int64_t>(ticks_of_speed(held, config_.rate));
    const std::int64_t relative = point_.velocity.raw() - source_.velocity.raw(), u = back ? -relative : relative;
    const std::int64_t square = d * d / 4 + 2 * d * left - d * u;
    const std::int64_t root =
        square > 0 ? static_cast<std::int64_t>(square_root(static_cast<std::uint64_t>(square))) : 0;
    return back ? d / 2 - root : root - d / 2;
  }

  Config config_;
  Point source_{}, point_{};
  bool beside_ = false;
  SaturationCounter saturations_;
};

}  // namespace stiction
