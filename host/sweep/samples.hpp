// Points of the unit cube for the keys of a sweep that have a distribution. Each coordinate of each point is computed
// from its numbers alone, so that any row of a sweep can be run by anyone, in any order, in no memory.
#pragma once

#include <cstdint>
#include <string_view>

namespace stiction::host {

enum class SampleMethod {
  latin_hypercube,  // McKay, Beckman, Conover 1979: each of n equal parts of each coordinate has one point
  sobol,            // Sobol's sequence with the direction numbers of Joe, Kuo 2008, shifted by the seed
};

// The most coordinates of a Sobol point: rows of the table of direction numbers.
inline constexpr std::uint32_t sobol_dimensions = 20;

// Coordinate `dimension` (from 0) of point `point` (from 0, below 2^32) of Sobol's sequence in the order of a Gray
// code, as 32 binary places. `dimension`: below sobol_dimensions.
std::uint32_t sobol_places(std::uint64_t point, std::uint32_t dimension);

// A permutation of 0 .. `count` - 1 that `key` chooses: where `index` goes. Four rounds of a Feistel network over the
// next even number of bits, walked until it is back in the range (Black, Rogaway 2002); constant memory.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key);

// Coordinate `dimension` (from 0) of point `point` of `count` points, within 0 and 1, neither of which is reached.
// `method`: how points are spread; `seed`: another seed gives other points.
double sample(SampleMethod method, std::uint64_t point, std::uint64_t count, std::uint32_t dimension,
              std::uint64_t seed);

// The value that a standard normal variable is below with `probability` (0 to 1, neither included), by Acklam's
// rational functions and one step of Halley's method; absolute error below 1e-9.
double normal_quantile(double probability);

}  // namespace stiction::host
