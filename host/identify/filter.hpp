// Zero-phase lowpass filters, differences and decimation, as identification needs them: the same filter on every
// regressor and on the force. Butterworth and Chebyshev type I by bilinear transform with prewarped edge (Oppenheim,
// Schafer, ch. 7), as second-order sections; forward and backward with the edges of MATLAB's filtfilt: an odd
// extension, and the state in which the filter would be had the first value been there for ever (Gustafsson 1996).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stiction::host {

// y = b0 x + b1 x- + b2 x-- - a1 y- - a2 y--
struct FilterSection {
  double b0, b1, b2, a1, a2;
};

// A lowpass of any order >= 1.
struct Lowpass {
  std::vector<FilterSection> sections;
  int order = 0;
};

// `edge`: -3 dB (Butterworth) or end of the ripple (Chebyshev), as a fraction of half the sampling rate, in (0, 1).
// Both throw std::invalid_argument for an order or an edge that is none.
Lowpass butterworth(int order, double edge);
// `order`: at least 1; `ripple_db`: of the passband, above 0 dB; `edge`: as above.
Lowpass chebyshev(int order, double ripple_db, double edge);

// The samples that filter_both_ways() adds at both ends unless told otherwise, 3 * order: MATLAB's and scipy's default.
std::size_t default_padding(const Lowpass& filter);

// Filters forward and backward: zero phase, |G|^2. `padding` samples at both ends, fewer where `values` is shorter.
// `filter`: applied once in each direction.
std::vector<double> filter_both_ways(const Lowpass& filter, std::span<const double> values, std::size_t padding);
// The same of several columns of one length, to the bit. Each sample waits for the one before it, so that four columns
// side by side take as long as one. `filter`, `padding`: as above.
std::vector<std::vector<double>> filter_both_ways(const Lowpass& filter,
                                                  std::span<const std::span<const double>> columns,
                                                  std::size_t padding);

// Derivative by central differences of 3 or 7 points; the ends by fewer points, the outermost one-sided. Its relative
// error at the angular frequency w is (w step)^2/6 with 3 points and (w step)^6/140 with 7. Needs two values.
std::vector<double> central_difference(std::span<const double> values, double step, int points = 3);

// First and second derivative by central differences of 11 points, of values extended oddly at both ends. The first is
// right to 1 % up to 0.24 of the sampling rate and 5.8 % low at 0.3 of it, the second to 0.2 and 1.2 %; at a tenth of
// the rate their errors are 3e-6 and 5e-7. `values`: at least two; `step`: between them.
struct Derivatives {
  std::vector<double> first, second;
};
Derivatives derivatives(std::span<const double> values, double step);

// Every `ratio`-th value, the last one among them (as MATLAB's decimate keeps them).
std::vector<double> every(std::span<const double> values, std::size_t ratio);

}  // namespace stiction::host
