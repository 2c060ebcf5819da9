// Angles of a turn, rad.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

namespace stiction::host::step {

inline constexpr double turn = 2.0 * std::numbers::pi;
inline constexpr double degree = std::numbers::pi / 180.0;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// The same angle from 0 to before a turn, and within half a turn of 0.
inline double wrapped(double angle) { return angle - turn * std::floor(angle / turn); }
inline double around_zero(double angle) { return angle - turn * std::round(angle / turn); }

}  // namespace stiction::host::step
