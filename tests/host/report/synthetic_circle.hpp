// A circle as the simulation might leave it, for tests of its report: quadrant glitches of the published heights, the
// machine's published and measured rows, and no plant.
#pragma once

#include <vector>

#include "host/report/circle_report.hpp"

namespace stiction::host {

struct SyntheticCircle {
  std::vector<double> feeds_m_per_min{3.2, 8.0, 16.0, 24.0, 48.0};
  std::vector<sim::Direction> directions{sim::Direction::counter_clockwise};
  bool measured = true;
  bool published = true;
};

CircleReport synthetic_circle(const SyntheticCircle& options = {});

}  // namespace stiction::host
