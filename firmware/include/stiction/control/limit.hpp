// Symmetric limit of a signal, with the fact that it acted.
#pragma once

namespace stiction {

template <class Signal>
struct Limited {
  Signal value;
  bool limiting;
};

template <class Signal>
constexpr Limited<Signal> limit(Signal value, Signal low, Signal high) {
  if (value > high) return {high, true};
  if (value < low) return {low, true};
  return {value, false};
}

}  // namespace stiction
