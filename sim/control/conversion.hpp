// The border between double precision and the signal types. It refuses what is not a number or out of range, so that
// neither can enter the fixed-point side unseen.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

#include "sim/control/double_signals.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction::sim {

constexpr double power_of_two(int exponent) {
  double power = 1.0;
  for (; exponent > 0; --exponent) power *= 2.0;
  for (; exponent < 0; ++exponent) power *= 0.5;
  return power;
}

// `value` in the format T, rounded to nearest, ties away from zero; nothing when it is NaN or beyond the format's range.
template <class T>
std::optional<T> to_signal(double value) {
  if constexpr (std::same_as<T, Real>) {
    return std::isfinite(value) ? std::optional(T{value}) : std::nullopt;
  } else {
    constexpr double scale = power_of_two(T::fraction_bits);
    const double scaled = value * scale;
    // No format reaches beyond 2^61, so the conversions are exact and rounding stays within 64 bits.
    static_assert(T::bound <= std::uint64_t{1} << 61);
    if (!(std::abs(scaled) < static_cast<double>(std::uint64_t{1} << 62))) return std::nullopt;  // NaN included
    const auto whole = static_cast<std::int64_t>(scaled);
    const double rest = scaled - static_cast<double>(whole);
    const std::int64_t raw = whole + (rest >= 0.5) - (rest <= -0.5);
    if (raw < T::lowest_raw || raw > T::highest_raw) return std::nullopt;
    return T::from_bounded_raw(raw);
  }
}

// The largest value that to_signal<T> takes; infinity for a type without a limit.
template <class T>
constexpr double highest() {
  if constexpr (std::same_as<T, Real>) {
    return std::numeric_limits<double>::infinity();
  } else {
    return static_cast<double>(T::highest_raw) * power_of_two(-T::fraction_bits);
  }
}

template <class T>
double to_si(T signal) {
  if constexpr (std::same_as<T, Real>) {
    return signal.value;
  } else {
    constexpr double scale = power_of_two(-T::fraction_bits);
    return static_cast<double>(signal.raw()) * scale;
  }
}

}  // namespace stiction::sim
