// Linear systems of the desk. Each decomposition of Eigen takes seconds to compile wherever it is called, so it is
// called in one source.
#pragma once

#include <Eigen/QR>

namespace stiction::host {

// The solution of least length of a least-squares problem, for matrices of any rank (Golub and Van Loan, Matrix
// Computations, 5.5: complete orthogonal decomposition).
class LeastSquares {
 public:
  // `matrix`: rows x columns. Pivots below `threshold` times the largest count as zero; negative: the rounding of a
  // double times the smaller dimension.
  explicit LeastSquares(const Eigen::MatrixXd& matrix, double threshold = -1.0);
  LeastSquares() = default;
  // `right`: a value for each row; the solution has one for each column.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd pseudo_inverse() const;  // columns x rows

 private:
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition_;
};

// The same by Householder's reflections with column pivoting, for matrices of full column rank or nearly so.
class PivotedLeastSquares {
 public:
  // `matrix`: rows x columns.
  explicit PivotedLeastSquares(const Eigen::MatrixXd& matrix);
  // `right`: a value for each row; the solution has one for each column.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition_;
};

// Solves matrix x = right for a symmetric positive semidefinite `matrix` (n x n) and `right` (n x any).
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

// The transpose of `a` (rows x n) times `b` (rows x m): n x m.
Eigen::MatrixXd transposed_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
// The transpose of `a` (rows x n) times `b` (a value for each row): n values.
Eigen::VectorXd transposed_times(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace stiction::host
