// The border between double precision and the signal types: that of the drive's own designs, with doubles as signals
// beside the fixed-point ones. It refuses what is not a number or out of range, so that neither can enter the
// fixed-point side unseen.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <utility>

#include "firmware/machine/configuration/double_signals.hpp"
#include "stiction/design/conversion.hpp"

template <>
struct stiction::design::Format<stiction::machine::Real> {
  static constexpr bool convert(double value, machine::Real& signal) {
    if (!std::isfinite(value)) return false;
    signal = {value};
    return true;
  }
  static constexpr double highest() { return std::numeric_limits<double>::infinity(); }
  static constexpr double to_si(machine::Real signal) { return signal.value; }
};

namespace stiction::machine {

// Writes `value` to `signal`, rounded to nearest, ties away from zero. False, and nothing written, when it is NaN or
// beyond the format's range.
template <class T>
bool convert(double value, T& signal) {
  return design::Format<T>::convert(value, signal);
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
  return design::Format<T>::highest();
}

template <class T>
double to_si(T signal) {
  return design::Format<T>::to_si(signal);
}

}  // namespace stiction::machine
