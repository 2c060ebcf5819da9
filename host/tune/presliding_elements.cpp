#include "host/tune/presliding_elements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiction::host {
namespace {

// The curve of first loading, scaled to distances after a reversal: a concave polygon with its corners at `distance`.
struct Curve {
  std::vector<double> x{0.0}, f{0.0};

  Curve(const std::vector<double>& distance, const std::vector<double>& level) {
    for (const double at : distance) {
      double sum = 0.0;
      for (std::size_t k = 0; k < distance.size(); ++k) sum += level[k] * std::min(1.0, at / distance[k]);
      x.push_back(at);
      f.push_back(sum);
    }
  }
  // Largest deviation of the chord from corner i to corner j.
  double deviation(std::size_t i, std::size_t j) const {
    double worst = 0.0;
    for (std::size_t k = i + 1; k < j; ++k)
      worst = std::max(worst, std::abs(f[k] - f[i] - (f[j] - f[i]) * (x[k] - x[i]) / (x[j] - x[i])));
    return worst;
  }
};

// The corners at which `pieces` chords deviate least, by dynamic programming over the last corner.
std::vector<std::size_t> best_corners(const Curve& curve, std::size_t pieces, double& error) {
  const std::size_t n = curve.x.size();
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> worst(pieces + 1, std::vector<double>(n, none));
  std::vector<std::vector<std::size_t>> from(pieces + 1, std::vector<std::size_t>(n, 0));
  worst[0][0] = 0.0;
  for (std::size_t p = 1; p <= pieces; ++p)
    for (std::size_t j = 1; j < n; ++j)
      for (std::size_t i = 0; i < j; ++i) {
        const double candidate = std::max(worst[p - 1][i], curve.deviation(i, j));
        if (candidate >= worst[p][j]) continue;
        worst[p][j] = candidate;
        from[p][j] = i;
      }
  std::size_t best = pieces;
  for (std::size_t p = pieces; p >= 1; --p)
    if (worst[p][n - 1] <= worst[best][n - 1] + 1e-12) best = p;
  error = worst[best][n - 1];
  std::vector<std::size_t> corners;
  for (std::size_t p = best, j = n - 1; p > 0; j = from[p--][j]) corners.push_back(j);
  std::reverse(corners.begin(), corners.end());
  return corners;
}

}  // namespace

PreslidingElements draw_together(const std::vector<double>& distance, const std::vector<double>& level,
                                 std::size_t count) {
  const Curve curve(distance, level);
  PreslidingElements elements;
  const auto corners = best_corners(curve, std::min(count, distance.size()), elements.error);
  const auto slope = [&](std::size_t i, std::size_t j) {
    return (curve.f[j] - curve.f[i]) / (curve.x[j] - curve.x[i]);
  };
  std::size_t before = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double rising = slope(before, corners[k]);
    const double after = k + 1 < corners.size() ? slope(corners[k], corners[k + 1]) : 0.0;
    before = corners[k];
    const double x = curve.x[corners[k]];
    elements.distance.push_back(x);
    elements.level.push_back(std::max(0.0, (rising - after) * x));
  }
  return elements;
}

}  // namespace stiction::host
