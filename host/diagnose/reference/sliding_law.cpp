#include "host/diagnose/reference/sliding_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/statistics/fisher.hpp"
#include "sim/effects/viscous_nonlinear/viscous_nonlinear.hpp"

namespace stiction::host {
namespace {

constexpr double named_below = 0.01;  // p of a part

using Chosen = std::array<bool, 3>;  // by SlidingPart

double& value_of(SlidingLaw& law, SlidingPart part) {
  return part == SlidingPart::coulomb ? law.coulomb : part == SlidingPart::viscous ? law.viscous : law.rise;
}

// Parameters that a part brings: a rise has its speed too.
int parameters_of(SlidingPart part) { return part == SlidingPart::rise ? 2 : 1; }

int parameters_of(const Chosen& chosen) {
  int count = 0;
  for (const auto part : sliding_parts)
    if (chosen[static_cast<std::size_t>(part)]) count += parameters_of(part);
  return count;
}

struct Solution {
  SlidingLaw law;
  double left = 0.0;  // sum of squares, N^2
};

class Fitter {
 public:
  Fitter(const std::vector<SteadyPoint>& points, const SlidingLaw& file) : points_(points), file_(file) {
    const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                                 [](const auto& a, const auto& b) { return a.velocity < b.velocity; });
    slowest_ = low->velocity;
    fastest_ = high->velocity;
  }

  Solution fit(const Chosen& chosen) const {
    if (!chosen[static_cast<std::size_t>(SlidingPart::rise)]) return linear(chosen, fastest_);
    // Scanned in steps of 2 %, then by golden section between the best step's neighbours.
    const int steps = static_cast<int>(std::log(fastest_ / slowest_) / 0.02) + 1;
    int best = 0;
    double least = INFINITY;
    for (int k = 0; k <= steps; ++k)
      if (const double left = linear(chosen, speed(k, steps)).left; left < least) least = left, best = k;
    double low = speed(std::max(best - 1, 0), steps), high = speed(std::min(best + 1, steps), steps);
    const double section = 0.5 * (std::sqrt(5.0) - 1.0);
    for (int k = 0; k < 40; ++k) {
      const double a = high - section * (high - low), b = low + section * (high - low);
      (linear(chosen, a).left < linear(chosen, b).left ? high : low) =
          linear(chosen, a).left < linear(chosen, b).left ? b : a;
    }
    return linear(chosen, 0.5 * (low + high));
  }

  // Standard errors by Gauss-Newton at the solution, from the points' scatter about it.
  SlidingLaw errors(const Chosen& chosen, const Solution& solution) const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    const int count = parameters_of(chosen);
    if (count == 0) return {};
    Eigen::MatrixXd slopes(n, count);
    const auto& law = solution.law;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double v = points_[static_cast<std::size_t>(i)].velocity,
                   decay = 1.0 - sim::ViscousNonlinear::risen(v / law.rise_velocity);
      Eigen::Index c = 0;
      if (chosen[0]) slopes(i, c++) = 1.0;
      if (chosen[1]) slopes(i, c++) = v;
      if (chosen[2]) {
        slopes(i, c++) = 1.0 - decay;
        slopes(i, c++) = -law.rise * decay * v / (law.rise_velocity * law.rise_velocity);
      }
    }
    const double variance = solution.left / static_cast<double>(n - count);
    const Eigen::VectorXd spread =
        (variance * LeastSquares(transposed_product(slopes, slopes)).pseudo_inverse()).diagonal().cwiseSqrt();
    SlidingLaw errors;
    Eigen::Index c = 0;
    for (const auto part : sliding_parts)
      if (chosen[static_cast<std::size_t>(part)]) value_of(errors, part) = spread[c++];
    if (chosen[2]) errors.rise_velocity = spread[c];
    return errors;
  }

 private:
  double speed(int k, int steps) const {
    return slowest_ * std::pow(fastest_ / slowest_, static_cast<double>(k) / steps);
  }

  Solution linear(const Chosen& chosen, double rise_velocity) const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    const auto count = std::count(chosen.begin(), chosen.end(), true);
    Eigen::MatrixXd columns(n, count);
    Eigen::VectorXd target(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& point = points_[static_cast<std::size_t>(i)];
      target[i] = point.force;
      Eigen::Index c = 0;
      const std::array values{1.0, point.velocity, sim::ViscousNonlinear::risen(point.velocity / rise_velocity)};
      const std::array known{file_.coulomb, file_.viscous, 0.0};
      for (std::size_t k = 0; k < 3; ++k)
        if (chosen[k])
          columns(i, c++) = values[k];
        else
          target[i] -= known[k] * values[k];
    }
    Solution solution{file_, 0.0};
    solution.law.rise_velocity = rise_velocity;
    if (count > 0) {
      const Eigen::VectorXd coefficients = PivotedLeastSquares(columns).solve(target);
      Eigen::Index c = 0;
      for (const auto part : sliding_parts)
        if (chosen[static_cast<std::size_t>(part)]) value_of(solution.law, part) = coefficients[c++];
      target -= columns * coefficients;
    }
    solution.left = target.squaredNorm();
    return solution;
  }

  const std::vector<SteadyPoint>& points_;
  SlidingLaw file_;
  double slowest_ = 0.0, fastest_ = 0.0;
};

// p of a part among the chosen ones: whether the fit without it is worse by more than the scatter.
SlidingPartTest test(const Fitter& fitter, const Chosen& chosen, SlidingPart part, double total, std::size_t points) {
  const auto place = static_cast<std::size_t>(part);
  auto with = chosen, without = chosen;
  with[place] = true;
  without[place] = false;
  const double left = fitter.fit(with).left, worse = fitter.fit(without).left;
  const int own = parameters_of(part), freedom = static_cast<int>(points) - parameters_of(with);
  const double f = (worse - left) / own / (left / freedom);
  return {part, chosen[place], fisher_tail(f, own, freedom), (worse - left) / total};
}

}  // namespace

double SlidingLaw::at(double velocity) const {
  return coulomb + viscous * velocity +
         (rise == 0.0 ? 0.0 : rise * sim::ViscousNonlinear::risen(velocity / rise_velocity));
}

SlidingFit fit_sliding_law(const std::vector<SteadyPoint>& points, const SlidingLaw& file) {
  if (points.size() < 7)
    throw MissingRows(
        fmt::format("steady friction: found {} speeds; expected at least 7, to tell four values from their scatter",
                    points.size()));
  const Fitter fitter(points, file);
  const double total = fitter.fit({false, false, false}).left;
  Chosen chosen{true, true, true};
  for (;;) {
    const SlidingPartTest* worst = nullptr;
    std::array<SlidingPartTest, 3> tests;
    for (const auto part : sliding_parts) {
      auto& own = tests[static_cast<std::size_t>(part)];
      own = test(fitter, chosen, part, total, points.size());
      if (own.named && (worst == nullptr || own.p_value > worst->p_value)) worst = &own;
    }
    if (worst != nullptr && worst->p_value >= named_below) {
      chosen[static_cast<std::size_t>(worst->part)] = false;
      continue;
    }
    const auto solution = fitter.fit(chosen);
    if (!(solution.law.coulomb > 0.0 && solution.law.viscous >= 0.0))
      throw MissingRows(
          fmt::format("steady friction: found a curve with {:.1f} N at standstill and {:.0f} N s/m; expected friction "
                      "above zero that grows with the speed",
                      solution.law.coulomb, solution.law.viscous));
    const auto rms = [&](double square) { return std::sqrt(square / static_cast<double>(points.size())); };
    double relative = 0.0;
    for (const auto& point : points) relative += std::pow(file.at(point.velocity) / point.force - 1.0, 2);
    return {solution.law, fitter.errors(chosen, solution), tests, relative, rms(total), rms(solution.left)};
  }
}

}  // namespace stiction::host
