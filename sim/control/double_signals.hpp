// The control laws' signal types in double precision: the same laws as the firmware's without rounding and limits of
// range. Tests use it to bound what fixed point costs, host tools where speed counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>

#include "stiction/number/fixed.hpp"

namespace stiction::sim {

// A double that takes part in the firmware's laws; nothing is rounded.
struct Real {
  double value = 0.0;

  constexpr Real operator-() const { return {-value}; }
  // One by one: the three-way comparison of doubles costs three of these.
  friend constexpr bool operator==(Real a, Real b) { return a.value == b.value; }
  friend constexpr bool operator<(Real a, Real b) { return a.value < b.value; }
  friend constexpr bool operator>(Real a, Real b) { return a.value > b.value; }
  friend constexpr bool operator<=(Real a, Real b) { return a.value <= b.value; }
  friend constexpr bool operator>=(Real a, Real b) { return a.value >= b.value; }
};

constexpr Real operator*(Real a, Real b) { return {a.value * b.value}; }
constexpr Real operator+(Real a, Real b) { return {a.value + b.value}; }
constexpr Real operator-(Real a, Real b) { return {a.value - b.value}; }

// A Real that holds a whole number: narrowing to it rounds by the firmware's rule.
struct WholeReal {
  double value = 0.0;
};
constexpr Real operator*(WholeReal a, Real b) { return {a.value * b.value}; }

// What rounding leaves of a Real.
struct NoResidue {};
constexpr Real operator+(Real a, NoResidue) { return a; }

template <class Out>
requires std::same_as<Out, Real>
constexpr Out narrow(Real x, SaturationCounter&) { return x; }
template <class Out>
requires std::same_as<Out, WholeReal>
inline Out narrow(Real x, SaturationCounter&) { return {std::round(x.value)}; }
template <class Out>
constexpr Real round_to(Real x) {
  return x;
}
template <class Out>
constexpr Real cut(Real x) {
  return x;
}
constexpr Real opposite(Real x) { return -x; }
constexpr Real negative(Real x) { return -x; }
constexpr Real saturated_sum(Real a, Real b, SaturationCounter&) { return a + b; }
constexpr Real saturated_difference(Real a, Real b, SaturationCounter&) { return a - b; }
inline bool exceeds(Real x, Real bound) { return std::abs(x.value) > bound.value; }

struct DoubleSignals {
  static constexpr const char* name = "double";

  using Position = Real;
  using Distance = Real;
  using Step = Real;
  using Velocity = Real;
  using Acceleration = Real;
  using Current = Real;
  using Voltage = Real;
  using Count = WholeReal;
  using Angle = Real;  // rad
  using Sine = Real;
  using Rate = Real;
  using Ticks = Real;
  using TickFraction = Real;
  using Seconds = Real;

  using PositionGain = Real;
  using VelocityWeight = Real;
  using IncrementInverse = Real;
  using Increment = Real;
  using VelocityGain = Real;
  using VelocityIntegralGain = Real;
  using VelocityIntegral = Real;
  using VelocityTracking = Real;
  using CurrentGain = Real;
  using CurrentIntegralGain = Real;
  using CurrentIntegral = Real;
  using CurrentTracking = Real;
  using AccelerationGain = Real;
  using CurrentSum = Real;
  using FilterCoefficient = Real;
  using FilterResidue = NoResidue;
  using PitchInverse = Real;
  using PeriodInverse = Real;

  static constexpr Rate rate(std::int64_t interval_ns) { return {1e9 / static_cast<double>(interval_ns)}; }
  static constexpr Ticks ticks(std::int64_t duration_ns, PeriodInverse inverse_period) {
    return {static_cast<double>(duration_ns) * inverse_period.value};
  }
  static constexpr Seconds seconds(std::int64_t duration_ns) { return {static_cast<double>(duration_ns) * 1e-9}; }

  struct Split {
    int whole;
    TickFraction fraction;
  };
  static constexpr Split split(Ticks delay, int highest) {
    const double positive = delay.value > 0.0 ? delay.value : 0.0;
    const double bounded = positive < highest + 1.0 ? positive : highest + 1.0;
    const int whole = std::min(static_cast<int>(bounded), highest);
    return {whole, {bounded - whole}};
  }

  static constexpr TickFraction complement(TickFraction fraction) { return {1.0 - fraction.value}; }
  static constexpr FilterResidue filter_residue(Real, Real) { return {}; }

  static constexpr Angle angle(Position position, PitchInverse inverse_pitch) {
    return {2.0 * std::numbers::pi * position.value * inverse_pitch.value};
  }
  static Sine sine(Angle angle) { return {std::sin(angle.value)}; }
  static constexpr Angle third_of_turn_after(Angle angle) { return {angle.value + 2.0 * std::numbers::pi / 3.0}; }
  static constexpr Real two_thirds() { return {2.0 / 3.0}; }
};

}  // namespace stiction::sim
