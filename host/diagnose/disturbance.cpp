#include "host/diagnose/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace stiction::host {

Disturbance::Disturbance(const Eigen::VectorXd& residual, std::span<const std::size_t> logs, double period)
    : spectrum_(residual, logs), period_(period) {
  const auto white = spectrum_(residual);
  deviation_ = std::sqrt(white.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(white.size(), 1)));
}

std::vector<double> Disturbance::drawn(std::span<const double> t, std::uint64_t seed) const {
  if (t.empty() || !*this) return std::vector<double>(t.size(), 0.0);
  constexpr Eigen::Index run_up = 500;  // rows, by which the start is forgotten
  const auto rows = static_cast<Eigen::Index>((t.back() - t.front()) / period_) + 2;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, deviation_);
  const Eigen::VectorXd force =
      spectrum_.coloured(Eigen::VectorXd::NullaryExpr(rows + run_up, [&] { return normal(random); })).tail(rows);
  std::vector<double> values;
  for (const double time : t) {
    const double place = (time - t.front()) / period_;
    const auto before = std::min(static_cast<Eigen::Index>(place), rows - 2);
    values.push_back(force[before] + (force[before + 1] - force[before]) * (place - static_cast<double>(before)));
  }
  return values;
}

}  // namespace stiction::host
