// The pictures of a verdict: the residual force before and after, over time, position and speed.
#pragma once

#include <Eigen/Dense>

#include "host/diagnose/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// `before`, `after`: residual force in the rows (N), with the file's machine and with all causes.
void add_charts(Verdict& verdict, const LogRows& rows, const Eigen::VectorXd& before, const Eigen::VectorXd& after);

}  // namespace stiction::host
