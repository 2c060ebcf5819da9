// Figures of a series of values.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace stiction::host {

// The middle one of `values`, at least one, which it puts into another order.
inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// 0 of none.
inline double largest_magnitude(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace stiction::host
