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
  Eigen::ArrayXd square, counts, weight, variance;
};

// Gives the rows that are `of` one state, 1 or 0 each, their variance and weights.
void weigh(White& white, const Eigen::ArrayXd& of) {
  const Eigen::ArrayXd counted = white.counts * of;
  const double rows = std::max(counted.sum(), 1.0);
  double variance = std::max((white.square * counted).sum() / rows, 1e-300);
  Eigen::ArrayXd weight;
  for (int k = 0; k < rounds; ++k) {
    weight = (freedom + 1.0) / (freedom + white.square / variance);
    variance = std::max((weight * white.square * counted).sum() / rows, 1e-300);
  }
  white.weight += of * weight;
  white.variance += of * variance;
}

White white_of(const Eigen::VectorXd& residual, const NoiseRows& rows, Memory memory) {
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(residual.size());
  White white{Whitening(residual, rows, memory), {}, (residual.array() != 0.0).cast<double>(), none, none};
  white.square = white.whitening(residual).array().square();
  if (white.whitening.at_rest().size() == 0) {
    weigh(white, none + 1.0);
  } else {
    weigh(white, white.whitening.at_rest().array());
    weigh(white, 1.0 - white.whitening.at_rest().array());
  }
  return white;
}

}  // namespace

Whitening noise_of(const Eigen::VectorXd& residual, const NoiseRows& rows, Memory memory) {
  auto white = white_of(residual, rows, memory);
  white.whitening.weigh((white.weight / white.variance).sqrt());
  return white.whitening;
}

double noise_log_likelihood(const Eigen::VectorXd& residual, const NoiseRows& rows) {
  const auto white = white_of(residual, rows, Memory::of_spans);
  const Eigen::ArrayXd each =
      -0.5 * (freedom + 1.0) * (white.square / (freedom * white.variance)).log1p() - 0.5 * white.variance.log();
  return (white.counts * each).sum();
}

double noise_log_likelihood(const Eigen::VectorXd& residual, const NoiseRows& rows, const Whitening& known) {
  const Eigen::ArrayXd counts = (residual.array() != 0.0).cast<double>();
  Eigen::ArrayXd white = Whitening(residual, rows, Memory::of_spans)(residual).array();
  if (known.weight().size() > 0) white *= known.weight().array();
  return -0.5 * counts.sum() * std::log(std::max((white.square() * counts).sum(), 1e-300));
}

}  // namespace stiction::host
