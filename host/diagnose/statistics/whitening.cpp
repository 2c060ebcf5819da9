#include "host/diagnose/statistics/whitening.hpp"

#include <algorithm>

namespace stiction::host {
namespace {

// Of rows at rest and of those in motion: fewer do not tell a spectrum of their own.
constexpr Eigen::Index fewest_rows = 300;

}  // namespace

Whitening::Whitening(const Eigen::VectorXd& residual, const NoiseRows& rows, Memory memory)
    : logs_(rows.logs.begin(), rows.logs.end()) {
  if (!rows.at_rest.empty()) {
    const Eigen::Map<const Eigen::VectorXd> rest(rows.at_rest.data(), residual.size());
    const Eigen::VectorXd of_rest = residual.cwiseProduct(rest), of_motion = residual - of_rest;
    const auto counted = [](const Eigen::VectorXd& part) { return (part.array() != 0.0).count(); };
    if (std::min(counted(of_rest), counted(of_motion)) >= fewest_rows) {
      // Spans would reach from the rows of one state into those of the other.
      at_rest_ = rest;
      still_ = Predictor(of_rest, logs_, Memory::of_rows);
      in_motion_ = Predictor(of_motion, logs_, Memory::of_rows);
      return;
    }
  }
  in_motion_ = Predictor(residual, logs_, memory);
}

Eigen::VectorXd Whitening::whitened(const Eigen::VectorXd& column, const Predictor& predictor) const {
  Eigen::VectorXd white(column.size());
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs_[k]);
    const auto length = static_cast<Eigen::Index>(end_of(logs_, k, column.size())) - begin;
    white.segment(begin, length) = predictor.errors(column.segment(begin, length));
    white.segment(begin, std::min(length, static_cast<Eigen::Index>(predictor.first()))).setZero();
  }
  return white;
}

Eigen::VectorXd Whitening::operator()(const Eigen::VectorXd& column) const {
  Eigen::VectorXd white = *this ? whitened(column, in_motion_) : column;
  if (at_rest_.size() > 0) white += at_rest_.cwiseProduct(whitened(column, still_) - white);
  if (weight_.size() > 0) white = white.cwiseProduct(weight_);
  return white;
}

Eigen::VectorXd Whitening::transposed(const Eigen::VectorXd& column, const Predictor& predictor) const {
  Eigen::VectorXd out(column.size());
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs_[k]);
    const auto length = static_cast<Eigen::Index>(end_of(logs_, k, column.size())) - begin;
    Eigen::VectorXd part = column.segment(begin, length);
    part.head(std::min(length, static_cast<Eigen::Index>(predictor.first()))).setZero();
    out.segment(begin, length) = predictor.transposed(part);
  }
  return out;
}

Eigen::VectorXd Whitening::transposed(const Eigen::VectorXd& column) const {
  const Eigen::VectorXd part = weight_.size() > 0 ? Eigen::VectorXd(column.cwiseProduct(weight_)) : column;
  if (!*this) return part;
  if (at_rest_.size() == 0) return transposed(part, in_motion_);
  const Eigen::VectorXd rest = part.cwiseProduct(at_rest_);
  return transposed(part - rest, in_motion_) + transposed(rest, still_);
}

Eigen::VectorXd Whitening::coloured(const Eigen::VectorXd& white, std::size_t first) const {
  Eigen::VectorXd out = white, sums(white.size() + 1);
  sums[0] = 0.0;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(first) + i;
    const auto& predictor = row < at_rest_.size() && at_rest_[row] != 0.0 ? still_ : in_motion_;
    out[i] += predictor.expected(static_cast<std::size_t>(i), out, sums);
    sums[i + 1] = sums[i] + out[i];
  }
  return out;
}

}  // namespace stiction::host
