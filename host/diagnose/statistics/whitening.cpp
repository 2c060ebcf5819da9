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

std::size_t end_of(std::span<const std::size_t> logs, std::size_t log, Eigen::Index rows) {
  return log + 1 < logs.size() ? logs[log + 1] : static_cast<std::size_t>(rows);
}

}  // namespace

Whitening::Whitening(const Eigen::VectorXd& residual, std::span<const std::size_t> logs)
    : logs_(logs.begin(), logs.end()) {
  std::vector<double> covariance(model_order + 1, 0.0);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto length = static_cast<Eigen::Index>(end_of(logs, k, residual.size())) - begin;
    for (Eigen::Index lag = 0; lag <= std::min(model_order, length - 1); ++lag)
      covariance[static_cast<std::size_t>(lag)] +=
          residual.segment(begin, length - lag).dot(residual.segment(begin + lag, length - lag));
  }
  if (!(covariance[0] > 0.0)) return;
  covariance[0] *= 1.0 + floor;
  double error = covariance[0];
  for (std::size_t m = 1; m <= static_cast<std::size_t>(model_order); ++m) {
    double reflection = covariance[m];
    for (std::size_t j = 0; j + 1 < m; ++j) reflection -= predictor_[j] * covariance[m - 1 - j];
    reflection /= error;
    auto next = predictor_;
    for (std::size_t j = 0; j + 1 < m; ++j) next[j] -= reflection * predictor_[m - 2 - j];
    next.push_back(reflection);
    predictor_ = std::move(next);
    error *= 1.0 - reflection * reflection;
  }
}

Eigen::VectorXd Whitening::operator()(const Eigen::VectorXd& column) const {
  if (predictor_.empty()) return weight_.size() > 0 ? Eigen::VectorXd(column.cwiseProduct(weight_)) : column;
  Eigen::VectorXd white = column;
  const auto back = predictor_.size();
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const std::size_t end = end_of(logs_, k, column.size()), first = std::min(logs_[k] + back, end);
    const auto length = static_cast<Eigen::Index>(end - first);
    for (std::size_t j = 0; j < back; ++j)
      white.segment(static_cast<Eigen::Index>(first), length) -=
          predictor_[j] * column.segment(static_cast<Eigen::Index>(first - 1 - j), length);
    white.segment(static_cast<Eigen::Index>(logs_[k]), static_cast<Eigen::Index>(first - logs_[k])).setZero();
  }
  if (weight_.size() > 0) white = white.cwiseProduct(weight_);
  return white;
}

Eigen::VectorXd Whitening::transposed(const Eigen::VectorXd& column) const {
  if (predictor_.empty()) return weight_.size() > 0 ? Eigen::VectorXd(column.cwiseProduct(weight_)) : column;
  Eigen::VectorXd out = Eigen::VectorXd::Zero(column.size());
  const auto back = predictor_.size();
  for (std::size_t k = 0; k < logs_.size(); ++k) {
    const std::size_t end = end_of(logs_, k, column.size()), first = std::min(logs_[k] + back, end);
    const auto length = static_cast<Eigen::Index>(end - first);
    Eigen::VectorXd part = column.segment(static_cast<Eigen::Index>(first), length);
    if (weight_.size() > 0) part = part.cwiseProduct(weight_.segment(static_cast<Eigen::Index>(first), length));
    out.segment(static_cast<Eigen::Index>(first), length) += part;
    for (std::size_t j = 0; j < back; ++j)
      out.segment(static_cast<Eigen::Index>(first - 1 - j), length) -= predictor_[j] * part;
  }
  return out;
}

Eigen::VectorXd Whitening::coloured(const Eigen::VectorXd& white) const {
  Eigen::VectorXd out = white;
  for (Eigen::Index i = 0; i < out.size(); ++i)
    for (std::size_t j = 0; j < predictor_.size() && static_cast<Eigen::Index>(j) < i; ++j)
      out[i] += predictor_[j] * out[i - 1 - static_cast<Eigen::Index>(j)];
  return out;
}

double Whitening::gain_square(double cycles) const {
  std::complex<double> sum = 1.0;
  for (std::size_t j = 0; j < predictor_.size(); ++j)
    sum -= predictor_[j] * std::polar(1.0, -2.0 * std::numbers::pi * cycles * static_cast<double>(j + 1));
  return std::norm(sum);
}

}  // namespace stiction::host
