// Least squares of a few parameters, with errors that hold where the deviations of neighbours belong together: the
// products of deviation and slope are summed over blocks, and the sums scatter as the parameters do (White's
// estimate, in blocks). The steps of an encoder that a slow motion crosses are such deviations.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace stiction::sim::cam {

template <std::size_t n>
using Vector = std::array<double, n>;
template <std::size_t n>
using Matrix = std::array<Vector<n>, n>;

// The inverse of a symmetric positive definite matrix `a` by Gauss and Jordan's elimination.
template <std::size_t n>
Matrix<n> inverse(Matrix<n> a) {
  Matrix<n> b{};
  for (std::size_t i = 0; i < n; ++i) b[i][i] = 1.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = a[k][k] != 0.0 ? 1.0 / a[k][k] : 0.0;
    for (std::size_t j = 0; j < n; ++j) a[k][j] *= pivot, b[k][j] *= pivot;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k];
      for (std::size_t j = 0; j < n; ++j) a[i][j] -= factor * a[k][j], b[i][j] -= factor * b[k][j];
    }
  }
  return b;
}

template <std::size_t n>
struct Normal {
  Matrix<n> matrix{};
  Vector<n> right{};

  // A `row` of slopes that is to make `value`.
  void add(const Vector<n>& row, double value) {
    for (std::size_t i = 0; i < n; ++i) {
      right[i] += row[i] * value;
      for (std::size_t j = 0; j < n; ++j) matrix[i][j] += row[i] * row[j];
    }
  }
  Vector<n> solve() const {
    const auto covariance = inverse(matrix);
    Vector<n> found{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) found[i] += covariance[i][j] * right[j];
    return found;
  }
};

// Variances of the parameters of a fit with those `rows` of slopes and `deviations` from it, both in the order of time:
// the larger ones of independent deviations and of deviations that belong together over `block` rows, such that 1.96
// times their roots hold 95 %.
template <std::size_t n>
Vector<n> variances(const std::vector<Vector<n>>& rows, const std::vector<double>& deviations, std::size_t block) {
  Normal<n> normal;
  Matrix<n> scores{};
  Vector<n> sum{};
  double squares = 0.0;
  std::size_t blocks = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    normal.add(rows[k], 0.0);
    squares += deviations[k] * deviations[k];
    for (std::size_t i = 0; i < n; ++i) sum[i] += rows[k][i] * deviations[k];
    if ((k + 1) % block != 0 && k + 1 != rows.size()) continue;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) scores[i][j] += sum[i] * sum[j];
    sum = {};
    ++blocks;
  }
  const auto inverted = inverse(normal.matrix);
  const auto of_blocks = static_cast<double>(blocks), of_rows = static_cast<double>(rows.size());
  const double freedom = std::max(1.0, of_blocks - static_cast<double>(n));
  // Scatter of a few blocks is not known well either: Student's quantile of 97.5 % over the normal one, by its
  // series in the degrees of freedom.
  constexpr double z = 1.959964, z2 = z * z;
  const double wider =
      1.0 + (z2 + 1.0) / (4.0 * freedom) + (5.0 * z2 * z2 + 16.0 * z2 + 3.0) / (96.0 * freedom * freedom);
  const double few = of_blocks / freedom * wider * wider;
  const double scatter = squares / std::max(1.0, of_rows - static_cast<double>(n));
  Vector<n> found{};
  for (std::size_t i = 0; i < n; ++i) {
    double together = 0.0;
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < n; ++k) together += inverted[i][j] * scores[j][k] * inverted[k][i];
    found[i] = std::max(scatter * inverted[i][i], few * together);
  }
  return found;
}

}  // namespace stiction::sim::cam
