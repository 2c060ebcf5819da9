// Exact arithmetic as the tests' oracle: 128-bit integers, rounding by division instead of by shifts, and RapidCheck
// with a fixed seed.
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace stiction::test {

__extension__ using Int128 = __int128;

// Every program repeats its cases; RapidCheck prints the line. RC_PARAMS of the environment takes precedence.
inline const bool seeded = [] {
  setenv("RC_PARAMS", "seed=2006 max_success=1000", 0);
  return true;
}();

inline std::string text(Int128 value) {
  if (value < 0) return "-" + text(-value);
  const std::string last(1, static_cast<char>('0' + static_cast<int>(value % 10)));
  return value < 10 ? last : text(value / 10) + last;
}

inline Int128 power_of_two(int exponent) { return Int128{1} << exponent; }

// numerator / denominator (> 0) to the nearest whole number, ties away from zero.
inline Int128 nearest(Int128 numerator, Int128 denominator) {
  const Int128 size = numerator < 0 ? -numerator : numerator;
  const Int128 rounded = (2 * size + denominator) / (2 * denominator);
  return numerator < 0 ? -rounded : rounded;
}

// raw * 2^-from expressed with `to` fraction bits, rounded to nearest, not saturated.
inline Int128 rescaled(Int128 raw, int from, int to) {
  return from > to ? nearest(raw, power_of_two(from - to)) : raw * power_of_two(to - from);
}

// The raw word of T that stands nearest to raw * 2^-from.
template <class T>
std::int64_t expected_raw(Int128 raw, int from) {
  const Int128 rounded = rescaled(raw, from, T::fraction_bits);
  return static_cast<std::int64_t>(
      std::clamp(rounded, static_cast<Int128>(T::lowest_raw), static_cast<Int128>(T::highest_raw)));
}
template <class T>
bool leaves_range(Int128 raw, int from) {
  return expected_raw<T>(raw, from) != rescaled(raw, from, T::fraction_bits);
}

// Raw words of T: uniform over the whole range, its ends, and small ones.
template <class T>
rc::Gen<std::int64_t> raw_words() {
  constexpr std::int64_t low = T::lowest_raw;
  constexpr std::int64_t high = T::highest_raw;
  return rc::gen::weightedOneOf<std::int64_t>(
      {{6, rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(low, high))},
       {2, rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(std::max<std::int64_t>(low, -1000),
                                                                            std::min<std::int64_t>(high, 1000)))},
       {2, rc::gen::elementOf(std::vector<std::int64_t>{low, low + 1, high - 1, high, 0})}});
}

template <class T>
T drawn() {
  return T::from_bounded_raw(*raw_words<T>());
}

// Uniform over [low, high].
inline std::int64_t drawn_between(std::int64_t low, std::int64_t high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(low, high + 1));
}

}  // namespace stiction::test
