#include "host/identify/initial_values.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/identify/fit_support.hpp"

namespace stiction::host {
namespace {

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double sign(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }

// The rows on both sides of a reversal: the last one before that slides and the first one behind.
struct Reversal {
  Eigen::Index before, after;
};

std::vector<Reversal> reversals_of(const LogRows& rows, const Eigen::VectorXd& sliding) {
  std::vector<Reversal> reversals;
  for (std::size_t log = 0; log < rows.logs().size(); ++log) {
    const std::size_t end = rows.end(log);
    std::optional<Eigen::Index> last;
    for (auto i = static_cast<Eigen::Index>(rows.logs()[log]); i < static_cast<Eigen::Index>(end); ++i) {
      if (sliding[i] == 0.0) continue;
      // Later than this the axis has stood, or accelerated to another force.
      constexpr double longest = 0.3;  // s
      if (last && rows.velocity[*last] * rows.velocity[i] < 0.0 && rows.time[i] - rows.time[*last] < longest)
        reversals.push_back({*last, i});
      last = i;
    }
  }
  return reversals;
}

}  // namespace

InitialValues initial_values(const LogRows& rows) {
  InitialValues values;
  if (rows.rows() == 0) return values;
  const auto sliding = fitting::steady_sliding(rows);
  const double highest = rows.acceleration.cwiseAbs().maxCoeff();
  double n = 0.0, sum_v = 0.0, sum_f = 0.0, sum_vv = 0.0, sum_vf = 0.0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (sliding[i] == 0.0 || std::abs(rows.acceleration[i]) > 0.05 * highest) continue;
    const double v = std::abs(rows.velocity[i]), f = rows.force[i] * sign(rows.velocity[i]);
    n += 1.0;
    sum_v += v;
    sum_f += f;
    sum_vv += v * v;
    sum_vf += v * f;
  }
  const double spread = n * sum_vv - sum_v * sum_v;
  if (n < 10.0 || spread < 1e-3 * sum_v * sum_v) return values;
  const double slope = (n * sum_vf - sum_v * sum_f) / spread, level = (sum_f - slope * sum_v) / n;
  values.viscous = slope;
  std::vector<double> masses;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    if (sliding[i] == 0.0 || std::abs(rows.acceleration[i]) < 0.5 * highest) continue;
    const double friction = level * sign(rows.velocity[i]) + slope * rows.velocity[i];
    masses.push_back((rows.force[i] - friction) / rows.acceleration[i]);
  }
  values.mass = median(std::move(masses));
  if (!values.mass) return values;
  std::vector<double> half_steps;
  for (const auto& [before, after] : reversals_of(rows, sliding)) {
    const auto without_mass = [&](Eigen::Index i) { return rows.force[i] - *values.mass * rows.acceleration[i]; };
    const double viscous = 0.5 * slope * std::abs(rows.velocity[after] - rows.velocity[before]);
    half_steps.push_back(0.5 * (without_mass(after) - without_mass(before)) * sign(rows.velocity[after]) - viscous);
  }
  values.coulomb = median(std::move(half_steps));
  // Where the axis hardly slides these readings mean nothing, and show it by their signs.
  if (*values.mass <= 0.0 || slope <= 0.0 || values.coulomb.value_or(1.0) <= 0.0) return {};
  return values;
}

}  // namespace stiction::host
