#include "host/diagnose/statistics/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/statistics/fisher.hpp"
#include "host/diagnose/statistics/level.hpp"

namespace stiction::host {
namespace {

// Of the noise that all clusters agree on, against what the few under a term say of their own.
constexpr double most_freedom = 30.0;

// Pseudo-inverse, in columns of one length, or newtons beside metres would hide a dependence.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& gram) {
  const Eigen::VectorXd scale = gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  const LeastSquares scaled(scale.asDiagonal() * gram * scale.asDiagonal(), 1e-9);
  return scale.asDiagonal() * scaled.pseudo_inverse() * scale.asDiagonal();
}

}  // namespace

Evidence::Evidence(Eigen::VectorXd target, std::vector<RowBlock> blocks)
    : target_(std::move(target)), blocks_(std::move(blocks)), clusters_(blocks_), white_(blocks_) {
  white_.add(target_);
}

Eigen::Index Evidence::add(const std::vector<Eigen::VectorXd>& columns) {
  const Eigen::Index first = this->columns();
  for (const auto& column : columns) {
    columns_.push_back(column);
    white_.add(whitening_(column));
  }
  return first;
}

void Evidence::truncate(Eigen::Index first) {
  columns_.resize(static_cast<std::size_t>(first));
  white_.truncate(place(first));
}

void Evidence::keep(const ColumnIndices& kept) {
  std::vector<Eigen::VectorXd> columns;
  for (const auto column : kept) columns.push_back(std::move(columns_[static_cast<std::size_t>(column)]));
  columns_ = std::move(columns);
  white_.keep(places(kept));
}

std::vector<std::size_t> Evidence::places(const ColumnIndices& columns) {
  std::vector<std::size_t> all{of_target};
  for (const auto column : columns) all.push_back(place(column));
  return all;
}

void Evidence::ask_for(const ColumnIndices& some, const ColumnIndices& others) const {
  const auto own = places(some);
  white_.ask_for(std::span(own).subspan(1), places(others));  // with the target's
}

void Evidence::retarget(Eigen::VectorXd target) {
  target_ = std::move(target);
  white_.replace(of_target, whitening_(target_));
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
  white_.truncate(0);
  white_.add(whitening_(target_));
  for (const auto& column : columns_) white_.add(whitening_(column));
}

Eigen::MatrixXd Evidence::white(const ColumnIndices& chosen) const {
  Eigen::MatrixXd columns(target_.size(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) = white_.column(place(chosen[i]));
  return columns;
}

// `each` (row, column, place of the one, of the other) for the entries of the lower triangle of the chosen columns'
// Gram matrix.
template <class Each>
void Evidence::for_pairs(const ColumnIndices& chosen, Each&& each) {
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      each(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j), place(chosen[i]), place(chosen[j]));
}

Evidence::Sums Evidence::total_of(const ColumnIndices& chosen) const {
  const auto count = static_cast<Eigen::Index>(chosen.size());
  white_.ask_for(places(chosen), {});
  Sums sums{Eigen::MatrixXd(count, count), Eigen::VectorXd(count), total()};
  for (Eigen::Index i = 0; i < count; ++i)
    sums.moment[i] = white_.total(of_target, place(chosen[static_cast<std::size_t>(i)]));
  for_pairs(chosen, [&](Eigen::Index i, Eigen::Index j, std::size_t one, std::size_t other) {
    sums.gram(i, j) = sums.gram(j, i) = white_.total(one, other);
  });
  return sums;
}

std::vector<Evidence::Sums> Evidence::by_block(const ColumnIndices& chosen) const {
  const auto count = static_cast<Eigen::Index>(chosen.size());
  std::vector<Sums> all(blocks_.size(), {Eigen::MatrixXd(count, count), Eigen::VectorXd(count), 0.0});
  white_.ask_for(places(chosen), {});
  const auto square = white_.by_block(of_target, of_target);
  for (std::size_t b = 0; b < all.size(); ++b) all[b].square = square[b];
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto moment = white_.by_block(of_target, place(chosen[static_cast<std::size_t>(i)]));
    for (std::size_t b = 0; b < all.size(); ++b) all[b].moment[i] = moment[b];
  }
  for_pairs(chosen, [&](Eigen::Index i, Eigen::Index j, std::size_t one, std::size_t other) {
    const auto product = white_.by_block(one, other);
    for (std::size_t b = 0; b < all.size(); ++b) all[b].gram(i, j) = all[b].gram(j, i) = product[b];
  });
  return all;
}

double Evidence::left(const Sums& sums, const Eigen::VectorXd& coefficients) {
  if (coefficients.size() == 0) return sums.square;
  return std::max(sums.square - 2.0 * coefficients.dot(sums.moment) + coefficients.dot(sums.gram * coefficients), 0.0);
}

Evidence::Fit Evidence::solve(const Sums& sums) {
  if (sums.moment.size() == 0) return {Eigen::VectorXd(0), sums.square};
  // Columns of one length, or newtons beside metres would hide a dependence.
  const Eigen::VectorXd scale =
      sums.gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  const Eigen::MatrixXd gram = scale.asDiagonal() * sums.gram * scale.asDiagonal();
  const Eigen::VectorXd coefficients =
      LeastSquares(gram, 1e-9).solve(scale.cwiseProduct(sums.moment)).cwiseProduct(scale);
  return {coefficients, left(sums, coefficients)};
}

Evidence::Fit Evidence::fit(const ColumnIndices& chosen) const { return solve(total_of(chosen)); }

Evidence::Fit Evidence::fit(const ColumnIndices& chosen, const std::vector<bool>& use) const {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Sums some{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0};
  const auto blocks = by_block(chosen);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!use[b]) continue;
    some.gram += blocks[b].gram;
    some.moment += blocks[b].moment;
    some.square += blocks[b].square;
  }
  return solve(some);
}

Eigen::VectorXd Evidence::residual(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const {
  Eigen::VectorXd r = target_;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    r -= coefficients[static_cast<Eigen::Index>(i)] * columns_[static_cast<std::size_t>(chosen[i])];
  return r;
}

Eigen::MatrixXd Evidence::inverse_gram(const ColumnIndices& chosen) const { return inverse(total_of(chosen).gram); }

Evidence::Jackknife Evidence::jackknife(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const {
  const auto k = static_cast<Eigen::Index>(chosen.size());
  const Eigen::MatrixXd gram = total_of(chosen).gram, all = inverse(gram), columns = white(chosen);
  const Eigen::VectorXd left = white_target() - columns * coefficients;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(k, k);
  Eigen::ArrayXd bearing = Eigen::ArrayXd::Zero(k), squares = bearing;
  for (const auto& cluster : clusters_) {
    const Eigen::MatrixXd own = columns.middleRows(static_cast<Eigen::Index>(cluster.begin),
                                                   static_cast<Eigen::Index>(cluster.end - cluster.begin));
    const Eigen::MatrixXd own_gram = transposed_product(own, own);
    const Eigen::VectorXd moved =
        inverse(gram - own_gram) *
        transposed_times(own, left.segment(static_cast<Eigen::Index>(cluster.begin), own.rows()));
    sum += moved * moved.transpose();
    const Eigen::ArrayXd share = (all * own_gram * all).diagonal().array();
    bearing += share;
    squares += share.square();
  }
  const double n = static_cast<double>(clusters_.size());
  return {(n - 1.0) / n * sum, bearing.square() / squares.max(1e-300)};
}

Eigen::MatrixXd Evidence::interval_covariance(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const {
  const auto [covariance, clusters] = jackknife(chosen, coefficients);
  Eigen::VectorXd wider =
      clusters.unaryExpr([](double c) { return student_limit(std::max(c - 1.0, 1.0)); }) / normal_limit;
  if (whitening_) {
    const double left = (white_target() - white(chosen) * coefficients).squaredNorm();
    const double freedom = static_cast<double>(std::max<Eigen::Index>(target_.size() - coefficients.size(), 1));
    const Eigen::MatrixXd even = left / freedom * inverse_gram(chosen);
    for (Eigen::Index i = 0; i < wider.size(); ++i)
      if (covariance(i, i) > 0.0) wider[i] *= std::sqrt(std::max(even(i, i) / covariance(i, i), 1.0));
  }
  return wider.asDiagonal() * covariance * wider.asDiagonal();
}

Eigen::MatrixXd Evidence::covariance(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients) const {
  const auto k = static_cast<Eigen::Index>(chosen.size());
  const Eigen::MatrixXd inverse = inverse_gram(chosen), columns = white(chosen);
  const Eigen::VectorXd left = white_target() - columns * coefficients;
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

Evidence::Test Evidence::test(const ColumnIndices& chosen, const Eigen::VectorXd& coefficients, Eigen::Index first,
                              Eigen::Index count) const {
  const Eigen::VectorXd own = coefficients.segment(first, count);
  const ColumnIndices of(chosen.begin() + first, chosen.begin() + first + count);
  Eigen::MatrixXd spread = covariance(chosen, coefficients).block(first, first, count, count);
  double freedom = std::max(bearing_clusters(of, own) - static_cast<double>(count), 2.0);
  // Where few clusters bear on a term, what all clusters say of the noise stands in for what those few cannot. Rows
  // that are correlated have no such variance.
  if (whitening_) {
    const auto all = noise(white_target() - white(chosen) * coefficients);
    const Eigen::MatrixXd even = all.variance * inverse_gram(chosen).block(first, first, count, count);
    spread = (all.freedom * even + freedom * spread) / (all.freedom + freedom);
    freedom += all.freedom;
  }
  const double wald = own.dot(LeastSquares(spread).solve(own)) / static_cast<double>(count);
  return {wald, fisher_tail(wald, static_cast<double>(count), freedom)};
}

double Evidence::bearing_clusters(const ColumnIndices& of, const Eigen::VectorXd& coefficients) const {
  double sum = 0.0, squares = 0.0;
  for (const double h : bearing(of, coefficients, clusters_)) {
    sum += h;
    squares += h * h;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

std::vector<double> Evidence::bearing(const ColumnIndices& of, const Eigen::VectorXd& coefficients) const {
  return bearing(of, coefficients, blocks_);
}

std::vector<double> Evidence::bearing(const ColumnIndices& of, const Eigen::VectorXd& coefficients,
                                      std::span<const RowBlock> pieces) const {
  const Eigen::VectorXd force = white(of) * coefficients;
  std::vector<double> squares;
  for (const auto& piece : pieces)
    squares.push_back(
        force.segment(static_cast<Eigen::Index>(piece.begin), static_cast<Eigen::Index>(piece.end - piece.begin))
            .squaredNorm());
  return squares;
}

std::vector<double> Evidence::held_out(const ColumnIndices& chosen, std::size_t folds) const {
  const auto blocks = by_block(chosen);
  const auto all = total_of(chosen);
  std::vector<double> square(blocks.size());
  for (std::size_t fold = 0; fold < folds; ++fold) {
    auto train = all;
    for (std::size_t b = fold; b < blocks.size(); b += folds) {
      train.gram -= blocks[b].gram;
      train.moment -= blocks[b].moment;
      train.square -= blocks[b].square;
    }
    const auto coefficients = solve(train).coefficients;
    for (std::size_t b = fold; b < blocks.size(); b += folds) square[b] = left(blocks[b], coefficients);
  }
  return square;
}

}  // namespace stiction::host
