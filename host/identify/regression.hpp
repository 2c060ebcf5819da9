// Linear least squares over blocks of rows, and what blocks are for: intervals and held-out errors that hold when the
// residual is correlated: a block is one piece of evidence, not each of its rows (Kuensch 1989; Cameron, Gelbach,
// Miller 2008).
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stiction::host {

// Root of the mean square; 0 of none.
inline double rms(const Eigen::VectorXd& v) {
  return v.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(v.size(), 1)));
}

// Rows begin <= i < end.
struct RowBlock {
  std::size_t begin, end;
};

// Sum of the residual's autocorrelation up to where it is lost in noise, in rows: rows further apart than a few of it
// say independent things. At least 1. `logs`: first row of each log.
double correlation_length(const Eigen::VectorXd& residual, std::span<const std::size_t> logs);

// Blocks of at least `shortest` rows within each log, cut at reversals (changes of sign of `velocity`) where these are
// far enough apart; pieces between reversals longer than twice that are cut evenly. `logs`: first row of each log.
std::vector<RowBlock> blocks_of(const Eigen::VectorXd& velocity, std::span<const std::size_t> logs,
                                std::size_t shortest);

class BlockRegression {
 public:
  // force = columns * weights, rows in `blocks`. Columns that depend on others share the weight (minimum norm).
  BlockRegression(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force, std::vector<RowBlock> blocks);

  std::size_t blocks() const { return blocks_.size(); }
  // Weights from all rows.
  Eigen::VectorXd solve() const;
  // The same with only the `chosen` columns.
  Eigen::VectorXd solve(std::span<const std::size_t> chosen) const;
  // Sum of squared residuals over all rows (N^2) with the chosen columns and their weights.
  double residual_sum(std::span<const std::size_t> chosen, const Eigen::VectorXd& weights) const;

  // Replicates of the weights, one a row: wild block bootstrap. The residual of each block keeps or changes its sign as
  // a whole, at random; the regressors stay, so that a few blocks are enough. The deviations from solve() are larger by
  // sqrt(blocks / (blocks - columns)): a fit follows its own blocks.
  Eigen::MatrixXd bootstrap(int replicates, std::uint64_t seed) const;

  // Mean square of the force (N^2) of what is left on blocks that were held out, every block once; block i in fold
  // i mod `folds`. Of several alternative column choices the training blocks choose the one with the least residual.
  double held_out(std::span<const std::vector<std::size_t>> alternatives, std::size_t folds) const;

 private:
  struct Sums {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
    double force = 0.0;  // sum of squares
  };
  static Eigen::VectorXd solve(const Sums& sums, std::span<const std::size_t> chosen);
  static double residual_sum(const Sums& sums, std::span<const std::size_t> chosen, const Eigen::VectorXd& weights);
  std::vector<std::size_t> all_columns() const;

  std::vector<RowBlock> blocks_;
  std::vector<Sums> sums_;  // of each block
  Sums total_;
  std::size_t rows_ = 0;
};

// Least squares on normal equations with columns `free` unbound and the rest not negative (Lawson, Hanson 1974).
// `columns`: one row per sample; `force`: as many rows.
Eigen::VectorXd solve_not_negative(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force, std::size_t free);

// 95 % interval of a quantity from its replicates around its value.
struct Interval {
  double low, high;
};
Interval interval_95(std::vector<double> replicates);

}  // namespace stiction::host
