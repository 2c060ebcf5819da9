// Symmetric limit of a signal, with the fact that it acted.
#pragma once

#include "stiction/number/fixed.hpp"

namespace stiction {

template <class Signal>
struct Limited {
  Signal value;
  int side;  // the limit that acted: -1 the low one, 1 the high one, 0 none

  constexpr bool limiting() const { return side != 0; }
};

// Holds |value| <= bound; the bound is not negative.
template <class Signal>
constexpr Limited<Signal> limit(Signal value, Signal bound) {
  if (!exceeds(value, bound)) [[likely]]
    return {value, 0};
  if (value > Signal{}) return {bound, 1};
  return {negative(bound), -1};
}

// The value alone, without a branch: for what saturates as a rule and not as an exception.
template <class Signal>
constexpr Signal clamped(Signal value, Signal bound) {
  const Signal low = negative(bound);
  const Signal below = value > bound ? bound : value;
  return below < low ? low : below;
}

// The same as limit() for an exact sum, rounded to the format of the bound first. The limit lies within the format, so
// that nothing else needs to saturate.
template <class Signal, class Sum>
constexpr Limited<Signal> limit_sum(Sum sum, Signal bound) {
  const auto rounded = round_to<Signal>(sum);
  if (!exceeds(rounded, bound)) [[likely]]
    return {cut<Signal>(rounded), 0};
  if (rounded > decltype(rounded){}) return {bound, 1};
  return {negative(bound), -1};
}

}  // namespace stiction
