// Uneven samples made even.
//
// A position is that of a mass: of all curves through the samples the cubic spline needs the least squared acceleration
// (J. C. Holladay, Math. Tables Aids Comput. 11, 1957), and its error is 5/384 of the fourth derivative times the
// fourth power of the step (C. A. Hall, J. Approx. Theory 1, 1968). Where a line is within the increment of the channel
// the line is taken. An effort may jump: it is a monotone cubic (M. Steffen, Astron. Astrophys. 239, 1990), which has
// no value beyond those of its two neighbours; so is a set position with jumps. Whole numbers are held.
#pragma once

#include <span>
#include <vector>

#include "host/log/log.hpp"

namespace stiction::host {

enum class Interpolation { spline, line, monotone, held };

// The values at `at` of the curve through (t, values). `t`: s, strictly rising, at least two; `values`: as many;
// `at`: s, rising, within t; `how`: the curve. Linear in the number of values.
std::vector<double> interpolated(std::span<const double> t, std::span<const double> values, std::span<const double> at,
                                 Interpolation how);

// The curve that suits a channel. `values`: of the channel; `smooth`: it is the position of a mass; `increment`: that
// the values were written with, in their unit, 0: none.
Interpolation interpolation_of(std::span<const double> values, bool smooth, double increment);

// `log` at even times from its first stamp to its last, as many as it has. `log`: strictly rising t, no blank cells.
Log made_even(const Log& log);

}  // namespace stiction::host
