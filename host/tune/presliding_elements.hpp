// Few presliding elements in the place of many: their force over distance is the best curve of as many straight pieces.
#pragma once

#include <cstddef>
#include <vector>

namespace stiction::host {

struct PreslidingElements {
  std::vector<double> distance;  // m after a reversal at which each slips again, increasing; at least one
  std::vector<double> level;     // A
  double error = 0.0;            // A, largest deviation of the curves
};

// `distance` increases, `level` is not negative; both equally long. At most `count` elements; their level is that of
// all together.
PreslidingElements draw_together(const std::vector<double>& distance, const std::vector<double>& level,
                                 std::size_t count);

}  // namespace stiction::host
