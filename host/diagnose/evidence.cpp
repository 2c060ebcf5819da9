#include "host/diagnose/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/diagnose/fisher.hpp"

namespace stiction::host {
namespace {

// Of the columns of a part() of them: all, in their order.
ColumnIndices own_columns(const ColumnIndices& chosen) {
  ColumnIndices own(chosen.size());
  std::iota(own.begin(), own.end(), Eigen::Index{0});
  return own;
}

// Of the noise that all clusters agree on, against what the few under a term say of their own.
constexpr double most_freedom = 30.0;

// Pseudo-inverse, in columns of one length, or newtons beside metres would hide a dependence.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& gram) {
  const Eigen::VectorXd scale = gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-9);
  decomposition.compute(scale.asDiagonal() * gram * scale.asDiagonal());
  return scale.asDiagonal() * decomposition.pseudoInverse() * scale.asDiagonal();
}

}  // namespace

Evidence::Evidence(Eigen::VectorXd target, std::vector<RowBlock> blocks)
    : target_(std::move(target)), blocks_(std::move(blocks)), clusters_(blocks_), sums_(blocks_.size()) {
  sum_target();
}

void Evidence::sum_target() {
  white_target_ = whitening_(target_);
  total_.square = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
    const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
    sums_[b].square = white_target_.segment(begin, length).squaredNorm();
    total_.square += sums_[b].square;
  }
}

Eigen::Index Evidence::add(const std::vector<Eigen::VectorXd>& columns) {
  const Eigen::Index first = columns_.cols();
  columns_.conservativeResize(target_.size(), first + static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) columns_.col(first + static_cast<Eigen::Index>(k)) = columns[k];
  sum_columns(first);
  return first;
}

void Evidence::whiten(Whitening whitening, std::size_t correlated) {
  whitening_ = std::move(whitening);
  clusters_.clear();
  for (const auto& block : blocks_) {
    const std::size_t length = block.end - block.begin;
    const std::size_t pieces = correlated > 0 ? std::max<std::size_t>(1, length / correlated) : 1;
    for (std::size_t p = 0; p < pieces; ++p)
      clusters_.push_back({block.begin + length * p / pieces, block.begin + length * (p + 1) / pieces});
  }
  sum_target();
  sum_columns(0);
}

// The sums of the columns from `first` on; those before it are there.
void Evidence::sum_columns(Eigen::Index first) {
  const Eigen::Index count = columns_.cols(), fresh = count - first;
  if (fresh == 0) return;
  white_columns_.conservativeResize(target_.size(), count);
  for (Eigen::Index j = first; j < count; ++j) white_columns_.col(j) = whitening_(columns_.col(j));
  const auto grow = [count](Sums& sums) {
    sums.gram.conservativeResize(count, count);
    sums.moment.conservativeResize(count);
  };
  grow(total_);
  total_.gram.rightCols(fresh).setZero();
  total_.gram.bottomRows(fresh).setZero();
  total_.moment.tail(fresh).setZero();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    auto& sums = sums_[b];
    grow(sums);
    const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
    const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
    const auto rows = white_columns_.middleRows(begin, length);
    sums.moment.tail(fresh).noalias() = rows.rightCols(fresh).transpose() * white_target_.segment(begin, length);
    sums.gram.rightCols(fresh).noalias() = rows.transpose() * rows.rightCols(fresh);
    sums.gram.bottomLeftCorner(fresh, first) = sums.gram.topRightCorner(first, fresh).transpose();
    total_.gram.rightCols(fresh) += sums.gram.rightCols(fresh);
    total_.gram.bottomLeftCorner(fresh, first) += sums.gram.bottomLeftCorner(fresh, first);
    total_.moment.tail(fresh) += sums.moment.tail(fresh);
  }
}

void Evidence::truncate(Eigen::Index first) {
  columns_.conservativeResize(Eigen::NoChange, first);
  white_columns_.conservativeResize(Eigen::NoChange, first);
  const auto cut = [first](Sums& sums) {
    sums.gram.conservativeResize(first, first);
    sums.moment.conservativeResize(first);
  };
  cut(total_);
  for (auto& sums : sums_) cut(sums);
}

Evidence::Sums Evidence::part(const Sums& sums, const ColumnIndices& chosen) {
  return {sums.gram(chosen, chosen), sums.moment(chosen), sums.square};
}

double Evidence::left(const Sums& sums, const ColumnIndices& chosen, const Eigen::VectorXd& weights) {
  if (chosen.empty()) return sums.square;
  const auto p = part(sums, chosen);
  return std::max(p.square - 2.0 * weights.dot(p.moment) + weights.dot(p.gram * weights), 0.0);
}

Evidence::Fit Evidence::solve(const Sums& sums, const ColumnIndices& chosen) {
  if (chosen.empty()) return {Eigen::VectorXd(0), sums.square};
  const auto p = part(sums, chosen);
  // Columns of one length, or newtons beside metres would hide a dependence.
  const Eigen::VectorXd scale =
      p.gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  const Eigen::MatrixXd gram = scale.asDiagonal() * p.gram * scale.asDiagonal();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-9);
  decomposition.compute(gram);
  const Eigen::VectorXd weights = decomposition.solve(scale.cwiseProduct(p.moment)).cwiseProduct(scale);
  return {weights, left(sums, chosen, weights)};
}

Evidence::Fit Evidence::fit(const ColumnIndices& chosen) const { return solve(total_, chosen); }

Evidence::Fit Evidence::fit(const ColumnIndices& chosen, const std::vector<bool>& use) const {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Sums some{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    if (!use[b]) continue;
    const auto p = part(sums_[b], chosen);
    some.gram += p.gram;
    some.moment += p.moment;
    some.square += p.square;
  }
  return solve(some, own_columns(chosen));
}

Eigen::VectorXd Evidence::residual(const ColumnIndices& chosen, const Eigen::VectorXd& weights) const {
  Eigen::VectorXd r = target_;
  for (std::size_t i = 0; i < chosen.size(); ++i) r -= weights[static_cast<Eigen::Index>(i)] * columns_.col(chosen[i]);
  return r;
}

Eigen::MatrixXd Evidence::inverse_gram(const ColumnIndices& chosen) const { return inverse(part(total_, chosen).gram); }

Eigen::MatrixXd Evidence::jackknife_covariance(const ColumnIndices& chosen, const Eigen::VectorXd& weights) const {
  const auto k = static_cast<Eigen::Index>(chosen.size());
  const Eigen::MatrixXd gram = part(total_, chosen).gram, columns = white_columns_(Eigen::all, chosen);
  const Eigen::VectorXd left = white_target_ - columns * weights;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(k, k);
  for (const auto& cluster : clusters_) {
    const auto own = columns.middleRows(static_cast<Eigen::Index>(cluster.begin),
                                        static_cast<Eigen::Index>(cluster.end - cluster.begin));
    const Eigen::VectorXd moved =
        inverse(gram - own.transpose() * own) *
        (own.transpose() * left.segment(static_cast<Eigen::Index>(cluster.begin), own.rows()));
    sum += moved * moved.transpose();
  }
  const double n = static_cast<double>(clusters_.size());
  return (n - 1.0) / n * sum;
}

Eigen::MatrixXd Evidence::covariance(const ColumnIndices& chosen, const Eigen::VectorXd& weights) const {
  const auto k = static_cast<Eigen::Index>(chosen.size());
  const Eigen::MatrixXd inverse = inverse_gram(chosen), columns = white_columns_(Eigen::all, chosen);
  const Eigen::VectorXd left = white_target_ - columns * weights;
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(k, k);
  for (const auto& cluster : clusters_) {
    const auto begin = static_cast<Eigen::Index>(cluster.begin);
    const auto length = static_cast<Eigen::Index>(cluster.end - cluster.begin);
    const Eigen::VectorXd score = columns.middleRows(begin, length).transpose() * left.segment(begin, length);
    meat += score * score.transpose();
  }
  const double n = static_cast<double>(clusters_.size());
  return n / std::max(n - static_cast<double>(k), 1.0) * inverse * meat * inverse;
}

// How evenly the noise lies over the clusters: their mean squares as if drawn around one variance with d0 degrees of
// freedom, from the first two moments of the F distribution.
Evidence::Noise Evidence::noise(const Eigen::VectorXd& left) const {
  double mean = 0.0, square = 0.0, rows = 0.0;
  const double n = static_cast<double>(clusters_.size());
  for (const auto& cluster : clusters_) {
    const double length = static_cast<double>(cluster.end - cluster.begin);
    const double each =
        left.segment(static_cast<Eigen::Index>(cluster.begin), static_cast<Eigen::Index>(cluster.end - cluster.begin))
            .squaredNorm() /
        length;
    mean += each / n;
    square += each * each / n;
    rows += length / n;
  }
  const double spread = rows * (square / (mean * mean) - 1.0);  // 2 where all clusters have one variance
  if (!(mean > 0.0)) return {0.0, 0.0};
  return {mean,
          spread > 2.0 ? std::min((4.0 * spread + 2.0 * rows - 4.0) / (spread - 2.0), most_freedom) : most_freedom};
}

Evidence::Test Evidence::test(const ColumnIndices& chosen, const Eigen::VectorXd& weights, Eigen::Index first,
                              Eigen::Index count) const {
  const Eigen::VectorXd own = weights.segment(first, count);
  const ColumnIndices of(chosen.begin() + first, chosen.begin() + first + count);
  Eigen::MatrixXd spread = covariance(chosen, weights).block(first, first, count, count);
  double freedom = std::max(bearing_clusters(of, own) - static_cast<double>(count), 2.0);
  // Where few clusters bear on a term, what all clusters say of the noise stands in for what those few cannot. Rows
  // that are correlated have no such variance.
  if (whitening_) {
    const auto all = noise(white_target_ - white_columns_(Eigen::all, chosen) * weights);
    const Eigen::MatrixXd even = all.variance * inverse_gram(chosen).block(first, first, count, count);
    spread = (all.freedom * even + freedom * spread) / (all.freedom + freedom);
    freedom += all.freedom;
  }
  const double wald = own.dot(spread.completeOrthogonalDecomposition().solve(own)) / static_cast<double>(count);
  return {wald, fisher_tail(wald, static_cast<double>(count), freedom)};
}

double Evidence::bearing_clusters(const ColumnIndices& of, const Eigen::VectorXd& weights) const {
  double sum = 0.0, squares = 0.0;
  for (const double h : bearing(of, weights, clusters_)) {
    sum += h;
    squares += h * h;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

std::vector<double> Evidence::bearing(const ColumnIndices& of, const Eigen::VectorXd& weights) const {
  return bearing(of, weights, blocks_);
}

std::vector<double> Evidence::bearing(const ColumnIndices& of, const Eigen::VectorXd& weights,
                                      std::span<const RowBlock> pieces) const {
  const Eigen::VectorXd force = white_columns_(Eigen::all, of) * weights;
  std::vector<double> squares;
  for (const auto& piece : pieces)
    squares.push_back(
        force.segment(static_cast<Eigen::Index>(piece.begin), static_cast<Eigen::Index>(piece.end - piece.begin))
            .squaredNorm());
  return squares;
}

std::vector<double> Evidence::held_out(const ColumnIndices& chosen, std::size_t folds) const {
  std::vector<double> square(sums_.size());
  const auto all = part(total_, chosen);
  const auto own = own_columns(chosen);
  for (std::size_t fold = 0; fold < folds; ++fold) {
    auto train = all;
    for (std::size_t b = fold; b < sums_.size(); b += folds) {
      const auto p = part(sums_[b], chosen);
      train.gram -= p.gram;
      train.moment -= p.moment;
      train.square -= p.square;
    }
    const auto weights = solve(train, own).weights;
    for (std::size_t b = fold; b < sums_.size(); b += folds) square[b] = left(sums_[b], chosen, weights);
  }
  return square;
}

}  // namespace stiction::host
