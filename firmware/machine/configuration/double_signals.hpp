// The control laws' signal types in double precision: the same laws as the firmware's without rounding and limits of
// range. Tests use it to bound what fixed point costs, host tools where speed counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>

#include "stiction/number/fixed.hpp"
#include "stiction/number/octave.hpp"
#include "stiction/number/trigonometry.hpp"

namespace stiction::machine {

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
// `a` + `b`; in double precision nothing saturates, and the SaturationCounter stays.
constexpr Real saturated_sum(Real a, Real b, SaturationCounter&) { return a + b; }
// `a` - `b`, likewise with its SaturationCounter.
constexpr Real saturated_difference(Real a, Real b, SaturationCounter&) { return a - b; }
inline bool exceeds(Real x, Real bound) { return std::abs(x.value) > bound.value; }

struct DoubleSignals {
  static constexpr const char* name = "double";
  template <class T>
  using Each = T;  // of this one axis

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
  using ContactStiffness = Real;
  using ContactSum = Real;
  using ContactDamping = Real;
  using PulseSlope = Real;

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

  // As the firmware's tables have it: their nodes are the same.
  static constexpr std::size_t speed_nodes = octave_nodes<16>;
  struct Place {
    std::size_t node;
    TickFraction fraction;
  };
  static Place speed_place(Velocity speed) { return place(speed.value, 0x1p-12, speed_nodes); }

  static constexpr Step bounded_step(Step dx) { return dx; }
  static constexpr Step add_steps(Step deflection, Step dx) { return deflection + dx; }

  static constexpr double longest_travel = 0x1p-9;
  static constexpr std::size_t travel_nodes = octave_nodes<20> - 1;
  static Step add_travel(Step travel, Step dx) { return {std::min(travel.value + std::abs(dx.value), longest_travel)}; }
  static bool far_travelled(Step travel) { return travel.value >= longest_travel; }
  static Place travel_place(Step travel) { return place(travel.value, 0x1p-20, travel_nodes + 1); }
  static TickFraction blend(Step travel) { return {std::max(0.0, 1.0 - travel.value * 0x1p15)}; }
  static int acceleration_octave(Acceleration a, int highest) {
    if (a.value == 0.0) return 0;
    return std::clamp(std::ilogb(a.value) + 6, 0, highest);
  }
  // Whether `value` is by a quarter above `reference`, beyond a `tolerance`; all in m.
  static bool has_grown(Distance value, Distance reference, Distance tolerance) {
    return value.value - tolerance.value > 1.25 * reference.value;
  }

  static constexpr TickFraction complement(TickFraction fraction) { return {1.0 - fraction.value}; }
  static constexpr FilterResidue filter_residue(Real, Real) { return {}; }

  static constexpr Angle angle(Position position, PitchInverse inverse_pitch) {
    return {2.0 * std::numbers::pi * position.value * inverse_pitch.value};
  }
  static constexpr Angle turned(Angle angle, Turn by) {
    return {angle.value + 2.0 * std::numbers::pi * 0x1p-32 * by.raw};
  }
  static Sine sine(Angle angle) { return {std::sin(angle.value)}; }
  static constexpr Angle third_of_turn_after(Angle angle) { return {angle.value + 2.0 * std::numbers::pi / 3.0}; }
  static constexpr Real two_thirds() { return {2.0 / 3.0}; }

 private:
  // In a table of `nodes` whose node 1 is at `first`; beyond its end at the end.
  static Place place(double magnitude, double first, std::size_t nodes) {
    if (magnitude < first) return {0, {magnitude / first}};
    int exponent = 0;
    const double mantissa = 2.0 * std::frexp(magnitude / first, &exponent);  // 1 .. 2
    const bool upper = mantissa >= 1.5;
    const std::size_t node = 1 + 2 * static_cast<std::size_t>(exponent - 1) + upper;
    if (node + 1 >= nodes) return {nodes - 2, {1.0}};
    return {node, {2.0 * (mantissa - (upper ? 1.5 : 1.0))}};
  }
};

}  // namespace stiction::machine
