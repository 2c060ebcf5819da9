// Test signals of a frequency response: a sum of sines of random phase that repeats after a whole number of samples
// (multisine), so that its spectrum has lines and nothing leaks between them. Random phases make what a nonlinearity
// adds look like noise from one realisation to the next (Pintelon and Schoukens, System Identification, 2012, 3.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace stiction::sim {

// Numbers of the lines, in periods of the test signal's period of `period` samples: about `per_decade` in a decade from
// the first to 0.95 of half the sample rate, and in whole numbers where these are further apart. A controller that
// samples every `slow_ratio`-th value folds a line of high frequency onto a low one; no two lines share such a place,
// and none falls on standstill. `period` is a multiple of `slow_ratio`.
std::vector<int> test_lines(int period, int slow_ratio, double per_decade);

// One period of the sum of these lines, all of the same amplitude, with its largest magnitude equal to `peak`.
// `period`: samples; `lines`: multiples of 1/period, below half of it; `seed`: of the phases.
std::vector<double> multisine(int period, std::span<const int> lines, double peak, std::uint64_t seed);

}  // namespace stiction::sim
