#include "host/diagnose/statistics/whitening.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stiction::host {
namespace {

// Rows looked back: slow and fast noise together have their poles and the zero between in it.
constexpr Eigen::Index model_order = 8;
// White noise that is added to the residual's, of its variance: the rows end at 0.8 of their band, and what lies above
// is no silence to listen to. Of the variance of the innovations alone, what a model gets wrong high in the band would
// outweigh what slow noise leaves below: tried, it gave a quarter more wrong names.
constexpr double floor = 0.01;
// Of rows at rest and of those in motion: fewer do not tell a spectrum of their own.
constexpr Eigen::Index fewest_rows = 300;

std::size_t end_of(std::span<const std::size_t> logs, std::size_t log, Eigen::Index rows) {
  return log + 1 < logs.size() ? logs[log + 1] : static_cast<std::size_t>(rows);
}

}  // namespace

Whitening::Predictor Whitening::predictor_of(const Eigen::VectorXd& residual, std::span<const std::size_t> logs) {
  std::vector<double> covariance(model_order + 1, 0.0);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto length = static_cast<Eigen::Index>(end_of(logs, k, residual.size())) - begin;
    for (Eigen::Index lag = 0; lag <= std::min(model_order, length - 1); ++lag)
      covariance[static_cast<std::size_t>(lag)] +=
          residual.segment(begin, length - lag).dot(residual.segment(begin + lag, length - lag));
  }
  Predictor predictor;
  if (!(covariance[0] > 0.0)) return predictor;
  covariance[0] *= 1.0 + floor;
  double error = covariance[0];
  for (std::size_t m = 1; m <= static_cast<std::size_t>(model_order); ++m) {
    double reflection = covariance[m];
    for (std::size_t j = 0; j + 1 < m; ++j) reflection -= predictor[j] * covariance[m - 1 - j];
    reflection /= error;
    auto next = predictor;
    for (std::size_t j = 0; j + 1 < m; ++j) next[j] -= reflection * predictor[m - 2 - j];
    next.push_back(reflection);
    predictor = std::move(next);
    error *= 1.0 - reflection * reflection;
  }
  return predictor;
}

Whitening::Whitening(const Eigen::VectorXd& residual, const NoiseRows& rows)
    : logs_(rows.logs.begin(), rows.logs.end()) {
  if (!rows.at_rest.empty()) {
    const Eigen::Map<const Eigen::VectorXd> rest(rows.at_rest.data(), residual.size());
    const Eigen::VectorXd of_rest = residual.cwiseProduct(rest), of_motion = residual - of_rest;
    const auto counted = [](const Eigen::VectorXd& part) { return (part.array() != 0.0).count(); };
    if (std::min(counted(of_rest), counted(of_motion)) >= fewest_rows) {
      at_rest_ = rest;
      still_ = predictor_of(of_rest, logs_);
      in_motion_ = predictor_of(of_motion, logs_);
      return;
    }
  }
  in_motion_ = predictor_of(residual, logs_);
}

Eigen::VectorXd Whitening::whitened(const Eigen::VectorXd& column, const Predictor& predictor) const {
  Eigen::VectorXd white = column;
  const auto back = predictor.size();
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const std::size_t end = end_of(logs_, k, column.size()), first = std::min(logs_[k] + back, end);
    const auto length = static_cast<Eigen::Index>(end - first);
    for (std::size_t j = 0; j < back; ++j)
      white.segment(static_cast<Eigen::Index>(first), length) -=
          predictor[j] * column.segment(static_cast<Eigen::Index>(first - 1 - j), length);
    white.segment(static_cast<Eigen::Index>(logs_[k]), static_cast<Eigen::Index>(first - logs_[k])).setZero();
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
  Eigen::VectorXd out = Eigen::VectorXd::Zero(column.size());
  const auto back = predictor.size();
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const std::size_t end = end_of(logs_, k, column.size()), first = std::min(logs_[k] + back, end);
    const auto length = static_cast<Eigen::Index>(end - first);
    const auto part = column.segment(static_cast<Eigen::Index>(first), length);
    out.segment(static_cast<Eigen::Index>(first), length) += part;
    for (std::size_t j = 0; j < back; ++j)
      out.segment(static_cast<Eigen::Index>(first - 1 - j), length) -= predictor[j] * part;
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
  Eigen::VectorXd out = white;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(first) + i;
    const auto& predictor = row < at_rest_.size() && at_rest_[row] != 0.0 ? still_ : in_motion_;
    for (std::size_t j = 0; j < predictor.size() && static_cast<Eigen::Index>(j) < i; ++j)
      out[i] += predictor[j] * out[i - 1 - static_cast<Eigen::Index>(j)];
  }
  return out;
}

double Whitening::gain_square(double cycles) const {
  std::complex<double> sum = 1.0;
  for (std::size_t j = 0; j < in_motion_.size(); ++j)
    sum -= in_motion_[j] * std::polar(1.0, -2.0 * std::numbers::pi * cycles * static_cast<double>(j + 1));
  return std::norm(sum);
}

}  // namespace stiction::host
