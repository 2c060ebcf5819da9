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
  if (!exceeds(value, bound)) return {value, 0};
  if (value > Signal{}) return {bound, 1};
  return {opposite(bound), -1};
}

}  // namespace stiction
