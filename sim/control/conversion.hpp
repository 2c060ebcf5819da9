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

// `value` in the format T, rounded to nearest; nothing when it is NaN or beyond the format's range.
template <class T>
std::optional<T> to_signal(double value) {
  if constexpr (std::same_as<T, Real>) {
    return std::isfinite(value) ? std::optional(T{value}) : std::nullopt;
  } else {
    const double raw = std::round(std::ldexp(value, T::fraction_bits));
    // 2^63 is the first double beyond the range of a 64-bit word; the bounds themselves may round up to it.
    if (!(raw >= static_cast<double>(T::lowest_raw) && raw <= static_cast<double>(T::highest_raw))) return std::nullopt;
    return T::from_bounded_raw(static_cast<std::int64_t>(raw));
  }
}

// The largest value that to_signal<T> takes; infinity for a type without a limit.
template <class T>
constexpr double highest() {
  if constexpr (std::same_as<T, Real>) {
    return std::numeric_limits<double>::infinity();
  } else {
    double value = static_cast<double>(T::highest_raw);
    for (int i = 0; i < T::fraction_bits; ++i) value *= 0.5;
    return value;
  }
}

template <class T>
double to_si(T signal) {
  if constexpr (std::same_as<T, Real>)
    return signal.value;
  else
    return std::ldexp(static_cast<double>(signal.raw()), -T::fraction_bits);
}

}  // namespace stiction::sim
