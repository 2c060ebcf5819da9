// The border between double precision and the signal types. It refuses what is not a number or out of range, so that
// neither can enter the fixed-point side unseen.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/number/fixed.hpp"

namespace stiction::machine {

constexpr double power_of_two(int exponent) {
  double power = 1.0;
  for (; exponent > 0; --exponent) power *= 2.0;
  for (; exponent < 0; ++exponent) power *= 0.5;
  return power;
}

// Writes `value` to `signal`, rounded to nearest, ties away from zero. False, and nothing written, when it is NaN or
// beyond the format's range.
template <class T>
bool convert(double value, T& signal) {
  if constexpr (std::same_as<T, Real>) {
    if (!std::isfinite(value)) return false;
    signal = {value};
  } else {
    constexpr double scale = power_of_two(T::fraction_bits);
    constexpr double lowest = static_cast<double>(T::lowest_raw), highest = static_cast<double>(T::highest_raw);
    const double scaled = value * scale;
    if constexpr (T::bound > std::uint64_t{1} << 52) {  // doubles of that size are whole
      static_assert(T::bound <= std::uint64_t{1} << 61);
      if (!(std::abs(scaled) <= highest)) return false;
    } else {
      if (!(scaled > lowest - 0.5 && scaled < highest + 0.5)) return false;
    }
    // Not 0.5 but the double before it: the sum's own rounding does the rest, and 0.5 would lift the double before a
    // half to the next whole number.
    signal = T::from_bounded_raw(static_cast<std::int64_t>(scaled + std::copysign(0x1.fffffffffffffp-2, scaled)));
  }
  return true;
}

// Several values at once. False when one of them has no place in its signal; for doubles nothing is written then. Of
// doubles only the sum is looked at: it is finite only if all of them are, and no quantity here comes near its limit.
template <class... T>
bool convert(const std::array<double, sizeof...(T)>& values, T&... signals) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    if constexpr ((std::same_as<T, Real> && ...)) {
      if (!std::isfinite((values[i] + ...))) return false;
      ((signals.value = values[i]), ...);
      return true;
    } else {
      return (convert(values[i], signals) && ...);
    }
  }
  (std::index_sequence_for<T...>{});
}

template <class T>
std::optional<T> to_signal(double value) {
  T signal;
  return convert(value, signal) ? std::optional(signal) : std::nullopt;
}

// The largest value that convert<T> takes; infinity for a type without a limit.
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

}  // namespace stiction::machine
