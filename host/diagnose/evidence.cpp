#include "host/diagnose/evidence.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {

Evidence::Evidence(Eigen::VectorXd target, std::vector<RowBlock> blocks)
    : target_(std::move(target)), blocks_(std::move(blocks)), sums_(blocks_.size()) {
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
  const auto first = static_cast<Eigen::Index>(columns_.size());
  columns_.insert(columns_.end(), columns.begin(), columns.end());
  sum_columns(first);
  return first;
}

void Evidence::whiten(Whitening whitening) {
  whitening_ = std::move(whitening);
  sum_target();
  white_columns_.clear();
  sum_columns(0);
}

// The sums of the columns from `first` on; those before it are there.
void Evidence::sum_columns(Eigen::Index first) {
  const auto count = static_cast<Eigen::Index>(columns_.size());
  for (Eigen::Index j = first; j < count; ++j)
    white_columns_.push_back(whitening_(columns_[static_cast<std::size_t>(j)]));
  const auto grow = [count](Sums& sums) {
    sums.gram.conservativeResize(count, count);
    sums.moment.conservativeResize(count);
  };
  grow(total_);
  total_.gram.rightCols(count - first).setZero();
  total_.gram.bottomRows(count - first).setZero();
  total_.moment.tail(count - first).setZero();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    auto& sums = sums_[b];
    grow(sums);
    const auto begin = static_cast<Eigen::Index>(blocks_[b].begin);
    const auto length = static_cast<Eigen::Index>(blocks_[b].end - blocks_[b].begin);
    for (Eigen::Index j = first; j < count; ++j) {
      const auto column = white_columns_[static_cast<std::size_t>(j)].segment(begin, length);
      sums.moment[j] = column.dot(white_target_.segment(begin, length));
      for (Eigen::Index i = 0; i <= j; ++i)
        sums.gram(i, j) = sums.gram(j, i) =
            column.dot(white_columns_[static_cast<std::size_t>(i)].segment(begin, length));
    }
    total_.gram.rightCols(count - first) += sums.gram.rightCols(count - first);
    total_.gram.bottomLeftCorner(count - first, first) += sums.gram.bottomLeftCorner(count - first, first);
    total_.moment.tail(count - first) += sums.moment.tail(count - first);
  }
}

void Evidence::truncate(Eigen::Index first) {
  columns_.resize(static_cast<std::size_t>(first));
  white_columns_.resize(static_cast<std::size_t>(first));
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
  const auto n = static_cast<Eigen::Index>(columns_.size());
  Sums some{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    if (!use[b]) continue;
    some.gram += sums_[b].gram;
    some.moment += sums_[b].moment;
    some.square += sums_[b].square;
  }
  return solve(some, chosen);
}

Eigen::VectorXd Evidence::residual(const ColumnIndices& chosen, const Eigen::VectorXd& weights) const {
  Eigen::VectorXd r = target_;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    r -= weights[static_cast<Eigen::Index>(i)] * columns_[static_cast<std::size_t>(chosen[i])];
  return r;
}

Eigen::MatrixXd Evidence::covariance(const ColumnIndices& chosen, const Eigen::VectorXd& weights) const {
  const auto k = static_cast<Eigen::Index>(chosen.size());
  const auto all = part(total_, chosen);
  const Eigen::VectorXd scale =
      all.gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(1e-9);
  decomposition.compute(scale.asDiagonal() * all.gram * scale.asDiagonal());
  const Eigen::MatrixXd inverse = scale.asDiagonal() * decomposition.pseudoInverse() * scale.asDiagonal();
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(k, k);
  for (const auto& sums : sums_) {
    const auto p = part(sums, chosen);
    const Eigen::VectorXd score = p.moment - p.gram * weights;
    meat += score * score.transpose();
  }
  const double n = static_cast<double>(blocks_.size());
  return n / std::max(n - static_cast<double>(k), 1.0) * inverse * meat * inverse;
}

double Evidence::bearing_blocks(const ColumnIndices& of, const Eigen::VectorXd& weights) const {
  double sum = 0.0, squares = 0.0;
  for (const auto& sums : sums_) {
    const double h = weights.dot(Eigen::MatrixXd(sums.gram(of, of)) * weights);
    sum += h;
    squares += h * h;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

std::vector<double> Evidence::held_out(const ColumnIndices& chosen, std::size_t folds) const {
  std::vector<double> square(sums_.size());
  const auto all = part(total_, chosen);
  ColumnIndices own(chosen.size());
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<Eigen::Index>(i);
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
