#include "host/diagnose/record/redrawn_residual.hpp"

#include <algorithm>
#include <random>

namespace stiction::host {
namespace {

constexpr double stretch = 0.25;  // s, of one sign

}  // namespace

RedrawnResidual::RedrawnResidual(Eigen::VectorXd residual, std::span<const std::size_t> logs, Eigen::VectorXd time,
                                 double period)
    : spectrum_(residual, logs), period_(period) {
  const Eigen::VectorXd white = spectrum_(residual);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto end = k + 1 < logs.size() ? static_cast<Eigen::Index>(logs[k + 1]) : white.size();
    innovations_.emplace_back(white.segment(begin, end - begin));
    begins_.push_back(end > begin ? time[begin] : 0.0);
  }
}

std::vector<double> RedrawnResidual::drawn(std::size_t log, std::span<const double> t, std::uint64_t seed) const {
  const auto& innovations = innovations_[log];
  if (t.empty() || innovations.size() < 2) return std::vector<double>(t.size(), 0.0);
  std::mt19937_64 random(seed);
  std::bernoulli_distribution negative;
  Eigen::VectorXd white = innovations;
  const auto rows = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(stretch / period_));
  // The first stretch ends anywhere, so that no row is always at the border of two.
  for (Eigen::Index begin = -static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(rows));
       begin < white.size(); begin += rows) {
    const auto first = std::max<Eigen::Index>(begin, 0), end = std::min(begin + rows, white.size());
    if (negative(random)) white.segment(first, end - first) *= -1.0;
  }
  const Eigen::VectorXd force = spectrum_.coloured(white);
  std::vector<double> values;
  for (const double time : t) {
    const double place = std::clamp((time - begins_[log]) / period_, 0.0, static_cast<double>(force.size() - 1));
    const auto before = std::min(static_cast<Eigen::Index>(place), force.size() - 2);
    values.push_back(force[before] + (force[before + 1] - force[before]) * (place - static_cast<double>(before)));
  }
  return values;
}

}  // namespace stiction::host
