#include "host/diagnose/judge/held_out_amplitude.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

// Of the product of both over one log, turned against each other.
double turned_variance(const Eigen::VectorXd& force, const Eigen::VectorXd& rest) {
  constexpr Eigen::Index turns = 64;
  const Eigen::Index length = force.size();
  double square = 0.0;
  for (Eigen::Index k = 1; k < turns; ++k) {
    const Eigen::Index by = length * k / turns;
    const double product = force.head(length - by).dot(rest.tail(length - by)) + force.tail(by).dot(rest.head(by));
    square += product * product;
  }
  return square / static_cast<double>(turns - 1);
}

}  // namespace

HeldOutAmplitude repetition_of(const Eigen::VectorXd& force, const Eigen::VectorXd& residual,
                               std::span<const std::size_t> logs, std::span<const RowBlock> blocks) {
  const double square = force.squaredNorm();
  if (!(square > 0.0)) return {};
  const double size = force.dot(residual) / square;
  const Eigen::VectorXd rest = residual - size * force;
  double by_blocks = 0.0, by_turns = 0.0;
  for (const auto& block : blocks) {
    const auto begin = static_cast<Eigen::Index>(block.begin), length = static_cast<Eigen::Index>(block.end) - begin;
    by_blocks += std::pow(force.segment(begin, length).dot(rest.segment(begin, length)), 2);
  }
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(logs[k]);
    const auto end = k + 1 < logs.size() ? static_cast<Eigen::Index>(logs[k + 1]) : force.size();
    by_turns += turned_variance(force.segment(begin, end - begin), rest.segment(begin, end - begin));
  }
  return {size, std::sqrt(std::max(by_blocks, by_turns)) / square};
}

}  // namespace stiction::host
