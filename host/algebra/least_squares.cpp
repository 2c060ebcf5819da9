#include "host/algebra/least_squares.hpp"

#include <Eigen/Cholesky>

namespace stiction::host {

LeastSquares::LeastSquares(const Eigen::MatrixXd& matrix, double threshold) {
  if (threshold >= 0.0) decomposition_.setThreshold(threshold);
  decomposition_.compute(matrix);
}

Eigen::VectorXd LeastSquares::solve(const Eigen::VectorXd& right) const { return decomposition_.solve(right); }

Eigen::MatrixXd LeastSquares::pseudo_inverse() const { return decomposition_.pseudoInverse(); }

PivotedLeastSquares::PivotedLeastSquares(const Eigen::MatrixXd& matrix) : decomposition_(matrix) {}

Eigen::VectorXd PivotedLeastSquares::solve(const Eigen::VectorXd& right) const { return decomposition_.solve(right); }

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a.transpose() * b; }

Eigen::VectorXd transposed_times(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) { return a.transpose() * b; }

}  // namespace stiction::host
