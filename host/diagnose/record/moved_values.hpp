// Values of a record at its rate, moved in time, and their rate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stiction::host {

// As one that shows everything so many `samples` earlier; between two `values` by a line, at the ends held.
inline std::vector<double> shown_earlier(const std::vector<double>& values, double samples) {
  if (samples == 0.0 || values.size() < 2) return values;
  const double last = static_cast<double>(values.size() - 1);
  std::vector<double> moved(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double place = std::clamp(static_cast<double>(k) + samples, 0.0, last);
    const auto before = std::min(static_cast<std::size_t>(place), values.size() - 2);
    moved[k] = values[before] + (values[before + 1] - values[before]) * (place - static_cast<double>(before));
  }
  return moved;
}

// Central differences of `values` over `period` (s); 0 at both ends.
inline std::vector<double> rate_over(const std::vector<double>& values, double period) {
  std::vector<double> rate(values.size(), 0.0);
  for (std::size_t k = 1; k + 1 < values.size(); ++k) rate[k] = (values[k + 1] - values[k - 1]) / (2.0 * period);
  return rate;
}

}  // namespace stiction::host
