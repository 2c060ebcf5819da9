// Where the clock of a record breaks, and how far its stamps are from even ones.
//
// A step is a gap where the jitter of the record does not explain it: above 1.5 times the usual step nearby (the median
// of 21 steps) and above six standard deviations of the steps. A change of rate is a place whose medians of 20 steps
// before and behind differ by more than a tenth and six standard errors.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/log/sampling.hpp"

namespace stiction::host {

// Samples [begin, end) of a record between two breaks.
struct Segment {
  std::size_t begin = 0, end = 0;
};

// `t`: s, strictly rising, at least two; `digits`: how the stamps were written. Linear in the number of samples.
std::vector<Segment> segments_of(std::span<const double> t, const StampDigits& digits);

// Standard deviation (s) of a stamp from the middle of its neighbours, as of a stamp with independent errors; what the
// rounding to the digits leaves is taken off, so that a clock that only drifts, or is only rounded, has none. `t`: s,
// strictly rising; `digits`: how the stamps were written.
double jitter_of(std::span<const double> t, const StampDigits& digits);

}  // namespace stiction::host
