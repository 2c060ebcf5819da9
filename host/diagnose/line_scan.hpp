// Lines in a residual beside those over position (ripple_scan.hpp): over time, over position in proportion to the
// expected force, and over the encoder's signal, whose error grows with the speed squared. What stands out of its
// surroundings is worth a try as a candidate's period.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

#include "host/identify/log_rows.hpp"
#include "sim/model/machine.hpp"

namespace stiction::host {

struct LineScan {
  std::vector<double> periods;  // s or m, the strongest first
  std::size_t trials = 0;       // independent periods that were looked at
  double extent = 0.0;          // s or m, over which the rows tell periods apart: 1/period within about 1/extent
};

// Periods in time (s). Every record has a phase of its own.
LineScan scan_times(const LogRows& rows, const Eigen::VectorXd& residual, std::size_t count);

// Pitches (m) of a force that is `carrier` (N, of the rows) times a wave over position; `known` are tried beside them.
LineScan scan_modulation(const LogRows& rows, const Eigen::VectorXd& residual, const Eigen::VectorXd& carrier,
                         std::span<const double> known, std::size_t count);

// Signal periods (m) of the encoder, 2 um to 1 mm: where the rows are slow enough to see them, and where the samples of
// the log fold the drive's answer down (reading_response.hpp). The count knows the signal: one phase in all records.
LineScan scan_signal_periods(const LogRows& rows, const Eigen::VectorXd& residual, const sim::Axis& axis,
                             const sim::Timing& timing, std::size_t count);

}  // namespace stiction::host
