#include "host/diagnose/record/redrawn_residual.hpp"

#include <algorithm>
#include <random>

namespace stiction::host {
namespace {

// Less the mean of each log's rows that count.
Eigen::VectorXd about_means(Eigen::VectorXd residual, std::span<const std::size_t> logs) {
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto end = k + 1 < logs.size() ? static_cast<Eigen::Index>(logs[k + 1]) : residual.size();
    auto rows = residual.segment(begin, end - begin);
    const auto count = (rows.array() != 0.0).count();
    if (count == 0) continue;
    const double mean = rows.sum() / static_cast<double>(count);
    rows = (rows.array() != 0.0).select(rows.array() - mean, 0.0).matrix().eval();
  }
  return residual;
}

}  // namespace

RedrawnResidual::RedrawnResidual(const Eigen::VectorXd& residual, const NoiseRows& rows, const Eigen::VectorXd& time,
                                 double period)
    : first_(rows.logs.begin(), rows.logs.end()), period_(period) {
  const auto logs = rows.logs;
  const Eigen::VectorXd noise = about_means(residual, logs);
  spectrum_ = Whitening(noise, rows, Memory::of_spans);
  const Eigen::VectorXd white = spectrum_(noise);
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
  for (double& innovation : white)
    if (negative(random)) innovation = -innovation;
  const Eigen::VectorXd force = spectrum_.coloured(white, first_[log]);
  std::vector<double> values;
  for (const double time : t) {
    const double place = std::clamp((time - begins_[log]) / period_, 0.0, static_cast<double>(force.size() - 1));
    const auto before = std::min(static_cast<Eigen::Index>(place), force.size() - 2);
    values.push_back(force[before] + (force[before + 1] - force[before]) * (place - static_cast<double>(before)));
  }
  return values;
}

}  // namespace stiction::host
