#include "host/identify/friction_curves.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/algebra/least_squares.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::host {
namespace {

// The least value of a function of one positive number: the best of 200 steps in the logarithm, refined by golden
// sections, so that a local dip beside it does no harm.
template <class Function>
double argument_of_minimum(double low, double high, const Function& cost) {
  constexpr int steps = 200;
  const double ratio = std::pow(high / low, 1.0 / steps);
  double best = low, least = cost(low);
  for (int i = 1; i <= steps; ++i) {
    const double x = low * std::pow(ratio, i);
    if (const double c = cost(x); c < least) {
      least = c;
      best = x;
    }
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = std::max(low, best / ratio), b = std::min(high, best * ratio);
  for (int i = 0; i < 60; ++i) {
    const double left = b - golden * (b - a), right = a + golden * (b - a);
    (cost(left) < cost(right) ? b : a) = cost(left) < cost(right) ? right : left;
  }
  return 0.5 * (a + b);
}

// Creeping, rise and viscous for a given rise velocity.
Eigen::Vector3d linear_part(const std::vector<SteadyPoint>& points, double rise_velocity, double* squares) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd regressors(n, 3);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    regressors.row(i) << 1.0, sim::MaxwellSlip<>::risen(point.velocity / rise_velocity), point.velocity;
    force[i] = point.force;
  }
  const Eigen::Vector3d solution = PivotedLeastSquares(regressors).solve(force);
  *squares = (regressors * solution - force).squaredNorm();
  return solution;
}

}  // namespace

double SteadyCurve::at(double velocity) const {
  return creeping + rise * sim::MaxwellSlip<>::risen(velocity / rise_velocity) + viscous * velocity;
}

SteadyCurve fit_steady_curve(const std::vector<SteadyPoint>& points) {
  if (points.size() < 5)
    throw MissingRows(fmt::format(
        "steady friction: found {} speeds; expected at least 5, from creeping to the highest speed", points.size()));
  const auto [slowest, fastest] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.velocity < b.velocity; });
  double squares = 0.0;
  const double rise_velocity = argument_of_minimum(slowest->velocity, fastest->velocity, [&](double candidate) {
    double cost = 0.0;
    linear_part(points, candidate, &cost);
    return cost;
  });
  const auto solution = linear_part(points, rise_velocity, &squares);
  SteadyCurve curve{solution[0], solution[1], rise_velocity, solution[2],
                    std::sqrt(squares / static_cast<double>(points.size()))};
  if (!(curve.creeping > 0.0 && curve.rise >= 0.0 && curve.viscous >= 0.0))
    throw MissingRows(
        fmt::format("steady friction: found a curve that falls ({:.1f} N creeping, {:.1f} N rise, {:.0f} N s/m); "
                    "expected friction that grows with the speed",
                    curve.creeping, curve.rise, curve.viscous));
  return curve;
}

double PreslidingCurve::force_at(double x) const {
  double x0 = 0.0, f0 = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (x <= displacement[i]) return f0 + (force[i] - f0) * (x - x0) / (displacement[i] - x0);
    x0 = displacement[i];
    f0 = force[i];
  }
  return f0;
}

PreslidingCurve presliding_curve(const std::vector<PreslidingPoint>& points) {
  auto against = points;
  std::erase_if(against, [](const PreslidingPoint& point) { return point.same_direction; });
  std::sort(against.begin(), against.end(), [](const auto& a, const auto& b) { return a.force < b.force; });
  if (against.size() < 2)
    throw MissingRows(fmt::format("presliding: found {} points loaded against the previous motion; expected at least 2",
                                  against.size()));
  PreslidingCurve curve;
  double slope = std::numeric_limits<double>::infinity(), x = 0.0, f = 0.0;
  for (const auto& point : against) {
    const double next = (point.force - f) / (point.displacement - x);
    if (!(next > 0.0 && next < slope))
      throw MissingRows(
          fmt::format("presliding: found {:g} um at {:g} N after {:g} um at {:g} N; expected displacements that grow "
                      "faster than the force",
                      point.displacement * 1e6, point.force, x * 1e6, f));
    slope = next;
    curve.displacement.push_back(x = point.displacement);
    curve.force.push_back(f = point.force);
  }
  return curve;
}

sim::MaxwellSlipParameters friction_elements(const SteadyCurve& sliding, const PreslidingCurve& presliding,
                                             double force, double displacement) {
  // Element i slips at point i; its stiffness is the fall of the curve's slope there.
  const double to_force = force * sliding.creeping / presliding.coulomb();
  const std::size_t count = presliding.force.size();
  std::vector<double> slope(count + 1, 0.0);  // up to point i; none beyond the last
  for (std::size_t i = 0; i < count; ++i) {
    const double x0 = i == 0 ? 0.0 : presliding.displacement[i - 1], f0 = i == 0 ? 0.0 : presliding.force[i - 1];
    slope[i] = to_force * (presliding.force[i] - f0) / (displacement * (presliding.displacement[i] - x0));
  }
  sim::MaxwellSlipParameters p;
  for (std::size_t i = 0; i < count; ++i) {
    p.stiffness.push_back(slope[i] - slope[i + 1]);
    p.level.push_back(p.stiffness.back() * displacement * presliding.displacement[i]);
  }
  p.viscous = force * sliding.viscous;
  p.rise = force * sliding.rise;
  p.rise_velocity = sliding.rise_velocity;
  return p;
}

}  // namespace stiction::host
