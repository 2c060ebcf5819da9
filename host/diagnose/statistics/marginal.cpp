#include "host/diagnose/statistics/marginal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace stiction::host {
namespace {

constexpr double step = 3.0;                                // from one size to the next
constexpr double smallest_size = 1e-3, largest_size = 2.0;  // of the residual's rms

double log_of_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double each : logs) sum += std::exp(each - most);
  return most + std::log(sum);
}

}  // namespace

Sizes sizes_beside(const Eigen::VectorXd& residual) {
  return {smallest_size * rms(residual), largest_size * rms(residual)};
}

Group add_group(Evidence& evidence, const std::vector<Eigen::VectorXd>& columns) {
  const auto count = static_cast<double>(columns.size());
  Group group{ColumnIndices(columns.size()), Eigen::VectorXd(static_cast<Eigen::Index>(columns.size()))};
  std::iota(group.columns.begin(), group.columns.end(), evidence.add(columns));
  for (std::size_t i = 0; i < columns.size(); ++i)
    group.deviation[static_cast<Eigen::Index>(i)] = 1.0 / std::max(std::sqrt(count) * rms(columns[i]), 1e-150);
  return group;
}

Posterior::Posterior(const Evidence& evidence, Sizes sizes) : evidence_(evidence), sizes_(sizes) {}

Posterior::Beside Posterior::beside(const Group& group) const {
  const auto own = static_cast<Eigen::Index>(group.columns.size()), in = static_cast<Eigen::Index>(columns_.size());
  evidence_.ask_for(group.columns, columns_);
  Beside b{Eigen::MatrixXd(in, own), Eigen::MatrixXd(own, own), Eigen::VectorXd(own)};
  for (Eigen::Index i = 0; i < own; ++i) {
    const auto column = group.columns[static_cast<std::size_t>(i)];
    b.moment[i] = evidence_.moment(column);
    for (Eigen::Index j = 0; j <= i; ++j)
      b.gram(i, j) = b.gram(j, i) = evidence_.product(column, group.columns[static_cast<std::size_t>(j)]);
    for (Eigen::Index j = 0; j < in; ++j)
      b.cross(j, i) = evidence_.product(column, columns_[static_cast<std::size_t>(j)]);
  }
  if (in > 0) {
    b.gram -= b.cross.transpose() * factor_.solve(b.cross);
    b.moment -= b.cross.transpose() * weights_;
  }
  return b;
}

// In the directions in which the group's prior and data are both diagonal the evidence of any size is a sum.
Posterior::Gain Posterior::gain_of(const Group& group) const {
  const auto b = beside(group);
  const Eigen::MatrixXd scaled = group.deviation.asDiagonal() * b.gram * group.deviation.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(0.5 * (scaled + scaled.transpose()));
  const Eigen::VectorXd length = axes.eigenvalues().cwiseMax(0.0);
  const Eigen::VectorXd seen = axes.eigenvectors().transpose() * group.deviation.cwiseProduct(b.moment);
  std::vector<double> logs;
  Gain gain{-std::numeric_limits<double>::infinity(), sizes_.smallest};
  double best = gain.nats;
  for (double size = sizes_.smallest; logs.empty() || size < step * sizes_.largest; size *= step) {
    double nats = 0.0;
    for (Eigen::Index i = 0; i < length.size(); ++i) {
      const double grown = 1.0 + size * size * length[i];
      nats += 0.5 * (size * size * seen[i] * seen[i] / grown - std::log(grown));
    }
    logs.push_back(nats);
    if (nats > best) best = nats, gain.size = size;
  }
  gain.nats = log_of_sum(logs) - std::log(static_cast<double>(logs.size()));
  return gain;
}

void Posterior::add(const Group& group) {
  const auto gain = gain_of(group);
  const auto b = beside(group);
  const auto in = static_cast<Eigen::Index>(columns_.size()), own = static_cast<Eigen::Index>(group.columns.size());
  Eigen::MatrixXd gram(in + own, in + own);
  gram.topLeftCorner(in, in) = gram_;
  gram.topRightCorner(in, own) = b.cross;
  gram.bottomLeftCorner(own, in) = b.cross.transpose();
  moment_.conservativeResize(in + own);
  precision_.conservativeResize(in + own);
  for (Eigen::Index i = 0; i < own; ++i) {
    const auto column = group.columns[static_cast<std::size_t>(i)];
    moment_[in + i] = evidence_.moment(column);
    precision_[in + i] = 1.0 / std::max(std::pow(gain.size * group.deviation[i], 2), 1e-300);
    for (Eigen::Index j = 0; j < own; ++j)
      gram(in + i, in + j) = evidence_.product(column, group.columns[static_cast<std::size_t>(j)]);
  }
  gram_ = std::move(gram);
  columns_.insert(columns_.end(), group.columns.begin(), group.columns.end());
  Eigen::MatrixXd whole = gram_;
  whole.diagonal() += precision_;
  factor_.compute(whole);
  weights_ = factor_.solve(moment_);
  nats_ += gain.nats;
}

double Posterior::price() const {
  if (columns_.empty()) return 0.0;
  return nats_ - (weights_.dot(moment_) - 0.5 * weights_.dot(gram_ * weights_));
}

Eigen::VectorXd Posterior::weights_with(const Group& group, double size) const {
  const auto b = beside(group);
  Eigen::MatrixXd left = b.gram;
  left.diagonal() += (size * group.deviation).cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd own = left.llt().solve(b.moment);
  Eigen::VectorXd all(weights_.size() + own.size());
  if (weights_.size() > 0) all.head(weights_.size()) = weights_ - factor_.solve(b.cross * own);
  all.tail(own.size()) = own;
  return all;
}

}  // namespace stiction::host
