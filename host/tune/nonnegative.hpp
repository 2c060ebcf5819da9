// Least squares with some unknowns not negative (Lawson, Hanson 1974, ch. 23), from the normal equations.
#pragma once

#include <Eigen/Dense>

namespace stiction::host {

// The w that minimises w' normal w - 2 right' w with w_k >= 0 for k < bounded. `normal`: symmetric, positive definite.
Eigen::VectorXd solve_nonnegative(const Eigen::MatrixXd& normal, const Eigen::VectorXd& right, Eigen::Index bounded);

}  // namespace stiction::host
