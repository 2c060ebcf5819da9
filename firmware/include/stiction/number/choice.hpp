// Choices on signals, as one axis takes them by a branch and a batch of axes lane by lane: a batch brings its own
// overloads, whose condition is one of every lane. For one axis each of these is the branch that its name says.
#pragma once

#include <concepts>

namespace stiction {

// One T for each axis of the policy S: T itself where S is of one axis.
template <class S, class T>
using Each = typename S::template Each<T>;

// Whether S is the policy of one axis.
template <class S>
concept OneAxis = std::same_as < Each<S, bool>,
bool > ;

// Whether `condition` holds for any axis, and for every one.
constexpr bool any(bool condition) { return condition; }
constexpr bool all(bool condition) { return condition; }

// `yes` where the `condition` holds, else `no`.
template <class T>
constexpr T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// `to` becomes `value` where the `condition` holds.
template <class T>
constexpr void assign(bool condition, T& to, const T& value) {
  if (condition) to = value;
}

}  // namespace stiction
