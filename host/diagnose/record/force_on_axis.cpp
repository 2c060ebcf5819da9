#include "host/diagnose/record/force_on_axis.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host {
namespace {

using Powers = Octaves::Powers;

Powers mean_powers(const Octaves& octaves, std::span<const ForceOnAxis::Answer> answers,
                   Eigen::VectorXd ForceOnAxis::Answer::*values) {
  Powers mean(octaves.count(), 0.0);
  for (const auto& answer : answers) {
    const auto own = octaves.of(answer.*values);
    for (std::size_t b = 0; b < mean.size(); ++b) mean[b] += own[b] / static_cast<double>(answers.size());
  }
  return mean;
}

}  // namespace

ForceOnAxis::ForceOnAxis(const Eigen::VectorXd& residual, const Eigen::VectorXd& speed,
                         std::span<const std::size_t> logs)
    : octaves_(logs, residual.size()),
      residual_(octaves_.of(residual)),
      speed_(octaves_.of(speed)),
      on_axis_(residual_),
      in_record_(residual_.size(), 0.0) {}

// The force with no more than these powers, and nothing where it is nothing.
Eigen::VectorXd ForceOnAxis::limited(const Eigen::VectorXd& force, const Powers& limits) const {
  auto gains = octaves_.of(force);
  for (std::size_t b = 0; b < gains.size(); ++b)
    gains[b] = limits[b] < gains[b] ? std::sqrt(limits[b] / gains[b]) : 1.0;
  return (force.array() != 0.0).select(octaves_.scaled(force, gains), 0.0);
}

ForceOnAxis::Parts ForceOnAxis::parts_of(const Eigen::VectorXd& force) const {
  if (residual_.empty()) return {force};
  Parts parts{limited(force, on_axis_)};
  if (std::any_of(in_record_.begin(), in_record_.end(), [](double power) { return power > 0.0; }))
    parts.in_record = limited(force, in_record_);
  return parts;
}

void ForceOnAxis::take_answers(std::span<const Answer> answers) {
  if (answers.empty()) return;
  const auto moved = mean_powers(octaves_, answers, &Answer::speed);
  for (std::size_t b = 0; b < on_axis_.size(); ++b)
    if (moved[b] > 0.0) on_axis_[b] = std::min(residual_[b], on_axis_[b] * speed_[b] / moved[b]);
}

void ForceOnAxis::take_remainders(std::span<const Answer> answers) {
  if (answers.empty()) return;
  const auto left = mean_powers(octaves_, answers, &Answer::left);
  for (std::size_t b = 0; b < in_record_.size(); ++b) in_record_[b] = std::max(residual_[b] - left[b], 0.0);
}

}  // namespace stiction::host
