// What is left when all causes are taken out, by what it looks like: periodic in position or in time, at a place, at
// reversals, with speed, with acceleration, drifting. A signature is no name.
#pragma once

#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// `residual`: N, in the rows; `baseline_square`: sum of squares before any cause was taken out (N^2). `correlation`:
// rows over which the residual is correlated; `units`: of the axis, for the words.
Unexplained signature_of(const LogRows& rows, const Eigen::VectorXd& residual, double baseline_square,
                         double correlation, const ShownUnits& units);

}  // namespace stiction::host
