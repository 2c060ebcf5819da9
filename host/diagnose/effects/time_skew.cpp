// The current recorded late against the position: F(t - delay) - F(t) with the force that the file expects, over the
// delay. The scanned delay is the place of the slope: at the true one the weight is the delay itself.
#include <algorithm>
#include <cmath>

#include "host/diagnose/candidate.hpp"
#include "host/diagnose/inverse_dynamics.hpp"

namespace stiction::host::effects {
namespace {

std::vector<double> grid(const SearchContext&) { return {1e-4, 1e-3, 3e-3, -1e-3, -3e-3}; }

// `values` at a time `delay` (s) earlier; cubic through four samples, the ends held.
std::vector<double> delayed(const std::vector<double>& values, double delay, double period) {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  std::vector<double> out(values.size());
  const double shift = delay / period;
  const double whole = std::floor(-shift), s = -shift - whole;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto k = i + static_cast<std::ptrdiff_t>(whole);
    const double a = at(k - 1), b = at(k), c = at(k + 1), d = at(k + 2);
    out[static_cast<std::size_t>(i)] = -s * (s - 1.0) * (s - 2.0) / 6.0 * a +
                                       (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * b -
                                       (s + 1.0) * s * (s - 2.0) / 2.0 * c + (s + 1.0) * s * (s - 1.0) / 6.0 * d;
  }
  return out;
}

Columns columns(const SearchContext& context, const Motion& motion, double delay) {
  const auto force = force_along(context.axis, motion);
  auto column = delayed(force, delay, motion.period);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = (column[i] - force[i]) / delay;
  return {column};
}
// Slopes far from the weight do not describe it.
bool possible(const SearchContext&, double delay, const Eigen::VectorXd& w) {
  return std::abs(delay) < 2e-4 || (w[0] * delay > 0.0 && w[0] / delay > 0.3 && w[0] / delay < 3.0);
}
void describe(const SearchContext&, double, const Eigen::VectorXd& w, const Eigen::MatrixXd& c, Finding& finding) {
  add_key(finding, "delay", "_s", {w[0]}, {std::sqrt(c(0, 0))});
}

}  // namespace

const Candidate time_skew{.name = "time_skew",
                          .grid = grid,
                          .columns = columns,
                          .possible = possible,
                          .describe = describe,
                          .at_weight = true};

}  // namespace stiction::host::effects
