// Places of the stroke at which a residual stands out: a tight spot of the guide, a cover that pushes. What stands out
// is worth a try as a candidate's place.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct Place {
  double at = 0.0;    // m
  double foot = 0.0;  // m, to either side of it
  bool operator==(const Place&) const = default;
};

// Those that were found so far: a value of a search keeps its meaning.
struct PlaceScan {
  std::vector<Place> places;
  std::size_t first_new = 0;  // of the last scan
  double trials = 1.0;        // independent places that were looked at

  // A place as the value of a candidate's nonlinear parameter, behind what the candidate's own grid has.
  static double value_of(std::size_t place) { return behind_grids + static_cast<double>(place); }
  static bool is_place(double value) { return value >= behind_grids; }
  const Place& at(double value) const { return places[static_cast<std::size_t>(value - behind_grids)]; }

 private:
  static constexpr double behind_grids = 1000.0;
};

// Adds the places between `lowest` and `highest` (m) at which a force that is `carrier` (of the rows) times a triangle
// over position takes most off the `residual` (N, of the rows), looked at through `whitening`: the best of each of six
// widths, from a tenth of the stroke down to 1/320 of it. `scan`: of the same carrier; `rows`: of the motion. The sums
// of a triangle are differences of running sums over position, so that the scan costs little beside sorting the rows.
void scan_places(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                 const Eigen::VectorXd& carrier, double lowest, double highest, PlaceScan& scan);

}  // namespace stiction::host
