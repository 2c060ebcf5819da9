// Pitches with peaks in the spectrum of a residual over position (order tracking).
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "host/diagnose/whitening.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

struct PitchScan {
  std::vector<double> pitches;  // m, the strongest first
  std::size_t trials = 0;       // independent pitches that were looked at
};

// `residual`: of the rows (N), looked at through `whitening`. `known`: pitches of the machine that are tried beside the
// scan (m). The scan's step in 1/pitch is a quarter of 1/(2 stroke): an entry 2 % off the true pitch is never found.
PitchScan scan_pitches(const LogRows& rows, const Eigen::VectorXd& residual, const Whitening& whitening,
                       std::span<const double> known, std::size_t count);

}  // namespace stiction::host
