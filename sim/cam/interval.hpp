// Intervals that certainly hold a real number: every operation rounds its ends outwards by one unit of the last place.
// IEEE 754 rounds a single operation by half a unit, so that the exact result lies inside (Moore 1966).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "sim/number/arithmetic.hpp"
#include "sim/number/sine_cosine.hpp"

namespace stiction::sim::cam {

// The next double above a finite `x`.
constexpr double next_above(double x) {
  if (x == 0.0) return 0x1p-1074;
  const auto bits = std::bit_cast<std::int64_t>(x);
  return std::bit_cast<double>(x > 0.0 ? bits + 1 : bits - 1);
}
constexpr double next_below(double x) { return -next_above(-x); }

struct Interval {
  double low = 0.0;
  double high = 0.0;

  constexpr Interval() = default;
  constexpr Interval(double point) : low(point), high(point) {}  // NOLINT(google-explicit-constructor)
  constexpr Interval(double lowest, double highest) : low(lowest), high(highest) {}

  // Around `middle`, at most `radius` away from it, which is not negative.
  static constexpr Interval around(double middle, double radius) {
    return {next_below(middle - radius), next_above(middle + radius)};
  }

  constexpr double magnitude() const { return std::max(absolute(low), absolute(high)); }

  friend constexpr Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
  friend constexpr Interval operator+(const Interval& a, const Interval& b) {
    return {next_below(a.low + b.low), next_above(a.high + b.high)};
  }
  friend constexpr Interval operator-(const Interval& a, const Interval& b) { return a + -b; }
  friend constexpr Interval operator*(const Interval& a, const Interval& b) {
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return {next_below(std::min(std::min(p, q), std::min(r, s))), next_above(std::max(std::max(p, q), std::max(r, s)))};
  }
  // `b` must not hold zero.
  friend constexpr Interval operator/(const Interval& a, const Interval& b) {
    return a * Interval{next_below(1.0 / b.high), next_above(1.0 / b.low)};
  }
};

using sim::exponential;  // of a double

// e^x of an interval; exponential() is within a unit of the last place, two are taken.
constexpr Interval exponential(const Interval& x) {
  const auto below = next_below(next_below(exponential(x.low)));
  return {std::max(below, 0.0), next_above(next_above(exponential(x.high)))};
}

// The sine of any angle in the interval: sine_cosine() is within 3e-16, and the slope of a sine at most 1.
inline Interval sine(const Interval& angle) {
  const double middle = 0.5 * (angle.low + angle.high);
  const double radius = std::max(angle.high - middle, middle - angle.low);
  const Interval value = Interval::around(sine_cosine(middle).sine, next_above(radius) + 4e-16);
  return {std::max(value.low, -1.0), std::min(value.high, 1.0)};
}

}  // namespace stiction::sim::cam
