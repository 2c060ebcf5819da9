// What the keys of a sweep do to a figure.
#pragma once

#include <string>
#include <vector>

#include "host/sweep/results.hpp"

namespace stiction::host {

// A key that varies, over the rows that are looked at.
struct VariedKey {
  std::string column;
  bool drawn = false;
  std::vector<double> numbers;        // of each row; of a drawn key
  std::vector<std::uint32_t> levels;  // of each row: which of `names`; of any other
  std::vector<std::string> names;
  std::vector<double> at;  // the number of each level; NaN of a text
};

// Main effects and interactions of `keys` on `figure`, whose value of each row is in `values` (NaN: none). Rows times
// the square of the number of keys.
FigureEffects effects_on(const SweepFigure& figure, const std::vector<double>& values,
                         const std::vector<VariedKey>& keys);

// The rows that no other beats in both figures, `first` and `second`, smaller being better, in the order of the first.
// `stride`: numbers of rows from one value to the next.
std::vector<ParetoPoint> pareto_front(const std::vector<double>& first, const std::vector<double>& second,
                                      std::uint64_t stride);

}  // namespace stiction::host
