// Lines in a residual: over position (order tracking), by itself or in proportion to the expected force; and over time.
// What stands out is worth a try as a candidate's period.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

#include "host/diagnose/statistics/whitening.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Of the rows' rate: how far lines show in them.
inline constexpr double rows_band = 0.4;

struct LineScan {
  std::vector<double> periods;  // s or m, the strongest first
  std::size_t trials = 0;       // independent periods that were looked at
  double extent = 0.0;          // s or m, over which the rows tell periods apart: 1/period within about 1/extent
};

// Periods in time (s). Every record has a phase of its own. `rows` and their `residual` force (N); `count`: of lines at
// most.
LineScan scan_times(const LogRows& rows, const Eigen::VectorXd& residual, std::size_t count);

// Pitches (m) of a force that is `carrier` (of the rows; ones, or N) times a wave over position, looked at through
// `whitening`; `known` are tried beside them. A wave that the rows see at a slowly changing frequency f comes out of
// the whitening |W(f)| times as large, so that no wave has to be whitened itself. The step in 1/pitch is a quarter of
// 1/(2 stroke): an entry 2 % off the true pitch is never found. `residual` force (N); `count`: of lines at most.
LineScan scan_pitches(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                      const Eigen::VectorXd& carrier, std::span<const double> known, std::size_t count);

}  // namespace stiction::host
