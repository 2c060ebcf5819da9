#include "host/diagnose/statistics/noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stiction::host {
namespace {

constexpr double freedom = 6.0;  // of Student's t
constexpr int rounds = 20;       // each takes the deviation to within a few percent of the rest

struct White {
  Whitening whitening;
  Eigen::ArrayXd square, counts, weight;
  double variance;
};

White white_of(const Eigen::VectorXd& residual, std::span<const std::size_t> logs) {
  White white{Whitening(residual, logs), {}, (residual.array() != 0.0).cast<double>(), {}, 0.0};
  white.square = white.whitening(residual).array().square();
  const double rows = std::max(white.counts.sum(), 1.0);
  white.variance = std::max((white.square * white.counts).sum() / rows, 1e-300);
  for (int k = 0; k < rounds; ++k) {
    white.weight = (freedom + 1.0) / (freedom + white.square / white.variance);
    white.variance = std::max((white.weight * white.square * white.counts).sum() / rows, 1e-300);
  }
  return white;
}

}  // namespace

Whitening noise_of(const Eigen::VectorXd& residual, std::span<const std::size_t> logs) {
  auto white = white_of(residual, logs);
  white.whitening.weigh((white.weight / white.variance).sqrt());
  return white.whitening;
}

double noise_log_likelihood(const Eigen::VectorXd& residual, std::span<const std::size_t> logs) {
  const auto white = white_of(residual, logs);
  const Eigen::ArrayXd each =
      -0.5 * (freedom + 1.0) * (white.square / (freedom * white.variance)).log1p() - 0.5 * std::log(white.variance);
  return (white.counts * each).sum();
}

double noise_log_likelihood(const Eigen::VectorXd& residual, std::span<const std::size_t> logs,
                            const Whitening& known) {
  const Eigen::ArrayXd counts = (residual.array() != 0.0).cast<double>();
  Eigen::ArrayXd white = Whitening(residual, logs)(residual).array();
  if (known.weight().size() > 0) white *= known.weight().array();
  return -0.5 * counts.sum() * std::log(std::max((white.square() * counts).sum(), 1e-300));
}

}  // namespace stiction::host
