// The project's own functions over arguments that are the same everywhere, so that a page's compilation of them can be
// compared with the desk's bit by bit.
#pragma once

#include <cstddef>
#include <vector>

namespace stiction::host {

enum class NumberFunction { sine, cosine, exponential, logarithm, square_root, arc_tangent, arc_cosine };

// `count` values of `function`: of angles within a million rad, exponents within those of a double, numbers of
// every magnitude for logarithm and square root, places of every direction and cosines, drawn by SplitMix64 (Steele,
// Lea, Flood 2014) from a fixed start.
std::vector<double> number_values(NumberFunction function, std::size_t count);

}  // namespace stiction::host
