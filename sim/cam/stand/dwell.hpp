// Where a cam rests, and how much the load still moves there.
#pragma once

#include <optional>
#include <vector>

#include "sim/cam/stand/response.hpp"

namespace stiction::sim::cam {

struct Dwell {
  double begin = 0.0;   // of the master, within the cycle
  double length = 0.0;  // may go on over the seam of a periodic cam

  double end() const { return begin + length; }
};

// The longest rest of `motion`; none where it never rests.
std::optional<Dwell> longest_dwell(const Motion& motion);

struct DwellFigures {
  double peak_to_peak = 0.0;  // of the load, in the slave's unit
  // The integral over the master of the load's distance from where it should be (Dostrasil 2014, 6.4: deg^2): an area,
  // not a square.
  double quality = 0.0;
  double mean = 0.0;  // of the load less where it should be
};

// Of `states` in the dwell of their last cycle that they hold as a whole; `motion` is what they follow, `dwell` its.
// Integrals by trapezoids between the states.
DwellFigures dwell_figures(const std::vector<LoadState>& states, const Motion& motion, const Dwell& dwell);

}  // namespace stiction::sim::cam
