#include "host/identify/regression.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "host/algebra/least_squares.hpp"

namespace stiction::host {
namespace {

std::size_t end_of_log(std::span<const std::size_t> logs, std::size_t log, Eigen::Index rows) {
  return log + 1 < logs.size() ? logs[log + 1] : static_cast<std::size_t>(rows);
}

// Whole rows between two reversals, or short runs of them together.
std::vector<RowBlock> runs_between_reversals(const Eigen::VectorXd& velocity, std::size_t begin, std::size_t end,
                                             std::size_t shortest) {
  std::vector<RowBlock> runs;
  std::size_t start = begin;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const bool reversal = velocity[static_cast<Eigen::Index>(i)] * velocity[static_cast<Eigen::Index>(i - 1)] <= 0.0;
    if (!reversal || i - start < shortest) continue;
    runs.push_back({start, i});
    start = i;
  }
  if (end - start >= shortest || runs.empty())
    runs.push_back({start, end});
  else
    runs.back().end = end;
  return runs;
}

}  // namespace

double correlation_length(const Eigen::VectorXd& residual, std::span<const std::size_t> logs) {
  const Eigen::Index n = residual.size();
  if (n < 4) return 1.0;
  const double variance = residual.squaredNorm() / static_cast<double>(n);
  if (variance == 0.0) return 1.0;
  double sum = 1.0;
  for (Eigen::Index lag = 1; lag < n / 4; ++lag) {
    double product = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < logs.size(); ++k) {
      const auto begin = static_cast<Eigen::Index>(logs[k]);
      const auto end = static_cast<Eigen::Index>(end_of_log(logs, k, n));
      if (end - begin <= lag) continue;
      product += residual.segment(begin, end - begin - lag).dot(residual.segment(begin + lag, end - begin - lag));
      count += static_cast<std::size_t>(end - begin - lag);
    }
    if (count == 0) break;
    const double correlation = product / static_cast<double>(count) / variance;
    // Two standard errors of the correlation of white noise.
    if (correlation < 2.0 / std::sqrt(static_cast<double>(count))) break;
    sum += 2.0 * correlation;
  }
  return sum;
}

std::vector<RowBlock> blocks_of(const Eigen::VectorXd& velocity, std::span<const std::size_t> logs,
                                std::size_t shortest) {
  std::vector<RowBlock> blocks;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const std::size_t end = end_of_log(logs, k, velocity.size());
    if (end == logs[k]) continue;
    for (const auto& run : runs_between_reversals(velocity, logs[k], end, shortest)) {
      const std::size_t length = run.end - run.begin;
      const std::size_t pieces = std::max<std::size_t>(1, length / shortest);
      for (std::size_t p = 0; p < pieces; ++p)
        blocks.push_back({run.begin + length * p / pieces, run.begin + length * (p + 1) / pieces});
    }
  }
  return blocks;
}

BlockRegression::BlockRegression(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force,
                                 std::vector<RowBlock> blocks)
    : blocks_(std::move(blocks)) {
  const Eigen::Index width = columns.cols();
  total_ = {Eigen::MatrixXd::Zero(width, width), Eigen::VectorXd::Zero(width), 0.0};
  for (const auto& block : blocks_) {
    const auto begin = static_cast<Eigen::Index>(block.begin);
    const auto length = static_cast<Eigen::Index>(block.end - block.begin);
    const Eigen::MatrixXd part = columns.middleRows(begin, length);
    const Eigen::VectorXd f = force.segment(begin, length);
    sums_.push_back({transposed_product(part, part), transposed_times(part, f), f.squaredNorm()});
    total_.gram += sums_.back().gram;
    total_.moment += sums_.back().moment;
    total_.force += sums_.back().force;
    rows_ += block.end - block.begin;
  }
}

std::vector<std::size_t> BlockRegression::all_columns() const {
  std::vector<std::size_t> all(static_cast<std::size_t>(total_.moment.size()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Eigen::VectorXd BlockRegression::solve(const Sums& sums, std::span<const std::size_t> chosen) {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  // Columns of one length: newtons beside metres would hide a dependence.
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto c = static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(i)]);
    const double length = std::sqrt(sums.gram(c, c));
    scale[i] = length > 0.0 ? 1.0 / length : 0.0;
  }
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd moment(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto ci = static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(i)]);
    moment[i] = sums.moment[ci] * scale[i];
    for (Eigen::Index j = 0; j < n; ++j)
      gram(i, j) = sums.gram(ci, static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(j)])) * scale[i] * scale[j];
  }
  return LeastSquares(gram, 1e-11).solve(moment).cwiseProduct(scale);
}

double BlockRegression::residual_sum(const Sums& sums, std::span<const std::size_t> chosen,
                                     const Eigen::VectorXd& weights) {
  double sum = sums.force;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto ci = static_cast<Eigen::Index>(chosen[i]);
    const double wi = weights[static_cast<Eigen::Index>(i)];
    sum -= 2.0 * wi * sums.moment[ci];
    for (std::size_t j = 0; j < chosen.size(); ++j)
      sum += wi * weights[static_cast<Eigen::Index>(j)] * sums.gram(ci, static_cast<Eigen::Index>(chosen[j]));
  }
  return std::max(sum, 0.0);
}

Eigen::VectorXd BlockRegression::solve() const { return solve(total_, all_columns()); }
Eigen::VectorXd BlockRegression::solve(std::span<const std::size_t> chosen) const { return solve(total_, chosen); }
double BlockRegression::residual_sum(std::span<const std::size_t> chosen, const Eigen::VectorXd& weights) const {
  return residual_sum(total_, chosen, weights);
}

Eigen::MatrixXd BlockRegression::bootstrap(int replicates, std::uint64_t seed) const {
  const auto all = all_columns();
  const Eigen::VectorXd centre = solve();
  const double n = static_cast<double>(blocks_.size());
  const double spare = std::max(n - static_cast<double>(all.size()), 1.0);
  const double wider = std::sqrt(n / spare);
  // What each block pulls the weights by.
  std::vector<Eigen::VectorXd> pulls;
  for (const auto& block : sums_) {
    const Sums pull{total_.gram, block.moment - block.gram * centre, 0.0};
    pulls.push_back(wider * solve(pull, all));
  }
  std::mt19937_64 random(seed);
  Eigen::MatrixXd result(replicates, centre.size());
  for (int r = 0; r < replicates; ++r) {
    Eigen::VectorXd weights = centre;
    for (const auto& pull : pulls) weights += (random() >> 63 != 0 ? 1.0 : -1.0) * pull;
    result.row(r) = weights.transpose();
  }
  return result;
}

double BlockRegression::held_out(std::span<const std::vector<std::size_t>> alternatives, std::size_t folds) const {
  double error = 0.0;
  for (std::size_t fold = 0; fold < std::min(folds, blocks_.size()); ++fold) {
    Sums train = total_, test{Eigen::MatrixXd::Zero(total_.gram.rows(), total_.gram.cols()),
                              Eigen::VectorXd::Zero(total_.moment.size()), 0.0};
    for (std::size_t k = fold; k < sums_.size(); k += folds) {
      test.gram += sums_[k].gram;
      test.moment += sums_[k].moment;
      test.force += sums_[k].force;
    }
    train.gram -= test.gram;
    train.moment -= test.moment;
    train.force -= test.force;
    double least = 0.0, of_least = 0.0;
    bool first = true;
    for (const auto& chosen : alternatives) {
      const auto weights = solve(train, chosen);
      const double left = residual_sum(train, chosen, weights);
      if (!first && left >= least) continue;
      first = false;
      least = left;
      of_least = residual_sum(test, chosen, weights);
    }
    error += of_least;
  }
  return error / static_cast<double>(rows_);
}

Eigen::VectorXd solve_not_negative(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force, std::size_t free) {
  const Eigen::Index n = columns.cols();
  Eigen::VectorXd scale = columns.colwise().norm().transpose();
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = scale[i] > 0.0 ? 1.0 / scale[i] : 0.0;
  const Eigen::MatrixXd gram = scale.asDiagonal() * transposed_product(columns, columns) * scale.asDiagonal();
  const Eigen::VectorXd moment = scale.cwiseProduct(transposed_times(columns, force));
  std::vector<bool> active(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = i < free;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  const auto solve_active = [&]() -> Eigen::VectorXd {
    std::vector<Eigen::Index> index;
    for (Eigen::Index i = 0; i < n; ++i)
      if (active[static_cast<std::size_t>(i)]) index.push_back(i);
    if (index.empty()) return Eigen::VectorXd::Zero(n).eval();
    const Eigen::MatrixXd g = gram(index, index);
    const Eigen::VectorXd solved = LeastSquares(g).solve(moment(index));
    Eigen::VectorXd full = Eigen::VectorXd::Zero(n);
    full(index) = solved;
    return full;
  };
  x = solve_active();
  for (int round = 0; round < 10 * static_cast<int>(n); ++round) {
    const Eigen::VectorXd gradient = moment - gram * x;
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!active[static_cast<std::size_t>(i)] && gradient[i] > 1e-9 && (best < 0 || gradient[i] > gradient[best]))
        best = i;
    if (best < 0) break;
    active[static_cast<std::size_t>(best)] = true;
    Eigen::VectorXd next = solve_active();
    // Back to the border where a weight would turn negative.
    for (;;) {
      double share = 1.0;
      Eigen::Index bound = -1;
      for (auto i = static_cast<Eigen::Index>(free); i < n; ++i)
        if (active[static_cast<std::size_t>(i)] && next[i] <= 0.0 && x[i] / (x[i] - next[i]) < share) {
          share = x[i] / (x[i] - next[i]);
          bound = i;
        }
      if (bound < 0) break;
      x += share * (next - x);
      x[bound] = 0.0;
      active[static_cast<std::size_t>(bound)] = false;
      next = solve_active();
    }
    x = next;
  }
  return scale.cwiseProduct(x);
}

Interval interval_95(std::vector<double> replicates) {
  std::sort(replicates.begin(), replicates.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(replicates.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, replicates.size() - 1);
    return replicates[below] + (place - static_cast<double>(below)) * (replicates[above] - replicates[below]);
  };
  return {at(0.025), at(0.975)};
}

}  // namespace stiction::host
