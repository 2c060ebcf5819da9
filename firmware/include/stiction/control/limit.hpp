// Symmetric limit of a signal, with the fact that it acted.
#pragma once

namespace stiction {

template <class Signal>
struct Limited {
  Signal value;
  bool limiting;

  // Which limit acted: -1 the low one, 1 the high one, 0 none.
  constexpr int side(Signal middle) const { return !limiting ? 0 : value > middle ? 1 : -1; }
};

template <class Signal>
constexpr Limited<Signal> limit(Signal value, Signal low, Signal high) {
  if (value > high) return {high, true};
  if (value < low) return {low, true};
  return {value, false};
}

}  // namespace stiction
