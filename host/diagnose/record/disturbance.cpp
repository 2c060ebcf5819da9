#include "host/diagnose/record/disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace stiction::host {
namespace {

constexpr double piece = 0.25;  // s
constexpr double bursts = 2.0;  // the square of all over that of the quieter half, which noise does not reach

// A row of 0 does not count: the axis stood there.
Eigen::Index counted(const Eigen::VectorXd& residual) { return (residual.array() != 0.0).count(); }

double square_of(const Eigen::VectorXd& residual) {
  return residual.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(counted(residual), 1));
}

struct Pieces {
  Eigen::VectorXd residual;
  std::vector<std::size_t> begins;
};

// The quieter half of a residual, of what counts.
Pieces quieter_half(const Eigen::VectorXd& residual, std::span<const std::size_t> logs, double period) {
  std::vector<Eigen::VectorXd> all;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const std::size_t end = k + 1 < logs.size() ? logs[k + 1] : static_cast<std::size_t>(residual.size());
    const std::size_t length = end - logs[k];
    const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(length) * period / piece));
    for (std::size_t p = 0; p < count; ++p) {
      const std::size_t first = logs[k] + length * p / count, last = logs[k] + length * (p + 1) / count;
      all.emplace_back(residual.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(last - first)));
      if (2 * counted(all.back()) < all.back().size()) all.pop_back();
    }
  }
  if (all.empty()) return {residual, {logs.begin(), logs.end()}};
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>((all.size() + 1) / 2);
  std::nth_element(all.begin(), middle - 1, all.end(),
                   [](const auto& a, const auto& b) { return square_of(a) < square_of(b); });
  Pieces pieces;
  for (auto each = all.begin(); each != middle; ++each) {
    pieces.begins.push_back(static_cast<std::size_t>(pieces.residual.size()));
    pieces.residual.conservativeResize(pieces.residual.size() + each->size());
    pieces.residual.tail(each->size()) = *each;
  }
  return pieces;
}

}  // namespace

Disturbance::Disturbance(const Eigen::VectorXd& residual, std::span<const std::size_t> logs, double period)
    : period_(period) {
  Pieces noise{residual, {logs.begin(), logs.end()}};
  const auto quiet = quieter_half(residual, logs, period);
  if (square_of(residual) > bursts * square_of(quiet.residual)) noise = quiet;
  mean_square_ = square_of(noise.residual);
  spectrum_ = Whitening(noise.residual, noise.begins, Memory::of_spans);
  deviation_ = std::sqrt(spectrum_(noise.residual).squaredNorm() /
                         static_cast<double>(std::max<Eigen::Index>(counted(noise.residual), 1)));
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
