// From the target positions that a motion controller sends each cycle (csp: CiA 402, 60C2h interpolation time period)
// to a set-point each tick: position, velocity and acceleration, all three continuous.
//
// A cycle is a polynomial of fifth degree in s = t / cycle between two targets (quintic Hermite segment, L. Biagiotti,
// C. Melchiorri, "Trajectory Planning for Automatic Machines and Robots", 2008, 2.1.7). Its ends are the targets
// themselves; way and change of way in a cycle at its end, V and A, are the backward differences of the last four
// targets that are exact for a motion of constant jerk,
//   V = (11 d1 - 7 d2 + 2 d3) / 6,  A = 2 d1 - 3 d2 + d3,  d1 the newest way from target to target;
// those at its begin are the ones of the cycle before. With D = d1 and what V differs from it, E0 and E1 at both ends:
//   p(s) = p0 + D s + E0 s + A0/2 s^2 + (-6 E0 - 4 E1 - 3/2 A0 + 1/2 A1) s^3 + (8 E0 + 7 E1 + 3/2 A0 - A1) s^4
//          + (-3 E0 - 3 E1 - 1/2 A0 + 1/2 A1) s^5
// A target that is taken is reached when the next one is due: one cycle of delay, no other. A step of the targets'
// velocity or acceleration is rounded within a cycle with an overshoot of these alone; what would take more than
// 0.49 mm a cycle beyond the mean way is cut, and position alone stays continuous there.
#pragma once

#include <cstdint>

#include "stiction/number/fixed.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction {

class SetPointInterpolator {
  // A small whole multiple.
  template <std::uint64_t K, int FractionBits, std::uint64_t Bound>
  static constexpr auto times(Wide<FractionBits, Bound> x) {
    static_assert(Bound <= static_cast<std::uint64_t>(INT64_MAX) / K);
    return Wide<FractionBits, K * Bound>::from_bounded_raw(static_cast<std::int64_t>(K) * x.raw());
  }
  // x t for 0 <= t <= 1, in the format of x.
  template <int FractionBits, std::uint64_t Bound>
  static constexpr auto of(Coefficient<24, 24> t, Wide<FractionBits, Bound> x) {
    SaturationCounter none;
    return narrow<Wide<FractionBits, Bound>>(x * t, none);
  }
  template <int FractionBits, std::uint64_t Bound>
  static constexpr auto half(Wide<FractionBits, Bound> x) {
    return Wide<FractionBits + 1, Bound>::from_bounded_raw(x.raw());
  }

 public:
  using S = FixedSignals;
  using Way = Wide<40, std::uint64_t{1} << 34>;        // of a cycle, +-15.6 mm
  using Deviation = Wide<40, std::uint64_t{1} << 29>;  // of E and A, +-0.49 mm
  using CycleRate = Coefficient<10, 24>;               // 1/s, cycles from 61 us

  struct Config {
    std::uint32_t ticks = 1;              // of a cycle
    std::uint64_t tick_share = 1u << 31;  // of a cycle, 2^52 / ticks
    CycleRate rate{};                     // 1 / cycle
    Way largest_way{};                    // of a cycle, to which extrapolation keeps
    Way largest_change{};                 // of the way from cycle to cycle
  };
  // `period_ns`: of a tick; `ticks`: of a cycle, above 0; `largest_way`: displacement in a cycle to which extrapolation
  // is limited; `largest_change`: of that from cycle to cycle, for can_take().
  static constexpr Config configure(std::int64_t period_ns, std::uint32_t ticks, Way largest_way,
                                    Way largest_change = Way::from_raw((std::int64_t{1} << 34) - 1)) {
    return {ticks, (std::uint64_t{1} << 52) / ticks,
            CycleRate::from_raw(static_cast<std::int32_t>(S::rate(period_ns * ticks).raw())), largest_way,
            largest_change};
  }

  struct Point {
    S::Position position{};
    S::Velocity velocity{};
    S::Acceleration acceleration{};
  };

  explicit constexpr SetPointInterpolator(const Config& config) : config_(config) {}

  // Stands at `position`.
  constexpr void start(S::Position position) {
    from_ = target_ = position;
    d1_ = d2_ = {};
    way_ = {};
    e0_ = e1_ = a0_ = a1_ = {};
    tick_ = 0;
  }

  // Whether the way to `target` is one that a cycle may have, after the one before. Positions within 2000 km.
  constexpr bool can_take(S::Position target) const {
    const auto way = target.raw() - target_.raw(), change = way - d1_.raw();
    const auto most = config_.largest_way.raw(), most_change = config_.largest_change.raw();
    return way <= most && way >= -most && change <= most_change && change >= -most_change;
  }

  // Once each config.ticks ticks, before step(): the target of the end of the cycle that begins.
  constexpr void take(S::Position target) {
    const auto way = narrow<Way>(target - target_, saturations_);
    from_ = target_;
    target_ = target;
    move(way);
  }
  // The same where none came: the motion goes on with the acceleration that it has.
  constexpr void extrapolate() {
    const auto& most = config_.largest_way;
    auto way = narrow<Way>(d1_ + d1_ - d2_, saturations_);
    way = way > most ? most : way < -most ? -most : way;
    from_ = target_;
    target_ = narrow<S::Position>(target_ + way, saturations_);
    move(way);
  }

  // The set-point of the coming tick; the first one after take() is where the cycle begins.
  constexpr Point step() {
    const auto share = static_cast<std::int64_t>((tick_ * config_.tick_share) >> 24);
    const auto s = Coefficient<28, 28>::from_bounded_raw(share);
    const auto t = Coefficient<24, 24>::from_bounded_raw(share >> 4);
    if (tick_ < config_.ticks) ++tick_;
    // Twice the coefficients, so that they are whole.
    const auto c1 = times<2>(e0_);
    const auto c2 = a0_;
    const auto c3 = a1_ - times<12>(e0_) - times<8>(e1_) - times<3>(a0_);
    const auto c4 = times<16>(e0_) + times<14>(e1_) + times<3>(a0_) - times<2>(a1_);
    const auto c5 = a1_ - times<6>(e0_) - times<6>(e1_) - a0_;
    const auto bent = half(of(t, of(t, of(t, of(t, of(t, c5) + c4) + c3) + c2) + c1));
    const auto speed = half(of(t, of(t, of(t, of(t, times<5>(c5)) + times<4>(c4)) + times<3>(c3)) + times<2>(c2)) + c1);
    const auto change = half(of(t, of(t, of(t, times<20>(c5)) + times<12>(c4)) + times<6>(c3)) + times<2>(c2));
    const auto along = narrow<Way>(way_ * s, saturations_);
    const auto way_of_cycle = narrow<CycleWay>(way_ + speed, saturations_);
    const auto velocity_of_cycle = narrow<CycleVelocity>(change * config_.rate, saturations_);
    return {narrow<S::Position>(from_ + along + narrow<Way>(bent, saturations_), saturations_),
            narrow<S::Velocity>(way_of_cycle * config_.rate, saturations_),
            narrow<S::Acceleration>(velocity_of_cycle * config_.rate, saturations_)};
  }

  constexpr S::Position target() const { return target_; }
  // Whether the set-point stands from the next cycle on if the targets do.
  constexpr bool at_rest() const {
    return d1_ == Way{} && d2_ == Way{} && e0_ == Deviation{} && a0_ == Deviation{} && e1_ == Deviation{} &&
           a1_ == Deviation{};
  }

 private:
  using CycleWay = Wide<40, std::uint64_t{1} << 38>;       // with what velocity overshoots
  using CycleVelocity = Wide<34, std::uint64_t{1} << 37>;  // +-8 m/s, change of velocity in a cycle

  constexpr void move(Way way) {
    // V of the begin is that of the end of the cycle before.
    e0_ = narrow<Deviation>(way_ + e1_ - way, saturations_);
    a0_ = a1_;
    const auto sixth = Coefficient<24, 22>::from_raw(2796203);
    e1_ = narrow<Deviation>((times<5>(way) - times<7>(d1_) + times<2>(d2_)) * sixth, saturations_);
    a1_ = narrow<Deviation>(times<2>(way) - times<3>(d1_) + d2_, saturations_);
    d2_ = d1_;
    d1_ = way;
    way_ = way;
    tick_ = 0;
  }

  Config config_;
  S::Position from_{}, target_{};
  Way way_{};              // D
  Way d1_{}, d2_{};        // ways of the last cycles
  Deviation e0_{}, e1_{};  // of the way in a cycle at both ends from D
  Deviation a0_{}, a1_{};  // its change
  std::uint32_t tick_ = 0;
  SaturationCounter saturations_;
};

}  // namespace stiction
