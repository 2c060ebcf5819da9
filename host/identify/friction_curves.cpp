#include "host/identify/friction_curves.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

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
  Eigen::MatrixX3d regressors(n, 3);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& point = points[static_cast<std::size_t>(i)];
    regressors.row(i) << 1.0, -std::expm1(-point.velocity / rise_velocity), point.velocity;
    force[i] = point.force;
  }
  const Eigen::Vector3d solution = regressors.colPivHouseholderQr().solve(force);
  *squares = (regressors * solution - force).squaredNorm();
  return solution;
}

// Displacement times initial stiffness, for a Coulomb friction.
double stretched(const PreslidingPoint& point, double coulomb) {
  const auto virgin = [&](double force) { return force / (1.0 - force / coulomb); };
  // Unloaded from sliding to no force, so on the branch of a reversal: it goes on, or turns round.
  return point.same_direction ? 2.0 * virgin(0.5 * point.force)
                              : 2.0 * virgin(0.5 * (coulomb + point.force)) - 2.0 * virgin(0.5 * coulomb);
}

double uncertainty(const PreslidingPoint& point) { return std::hypot(0.4e-6, 0.1 * point.displacement); }

// Compliance for a given Coulomb friction.
double compliance(const std::vector<PreslidingPoint>& points, double coulomb, double* squares) {
  double product = 0.0, square = 0.0;
  for (const auto& point : points) {
    const double regressor = stretched(point, coulomb) / uncertainty(point);
    product += regressor * point.displacement / uncertainty(point);
    square += regressor * regressor;
  }
  const double solution = product / square;
  *squares = 0.0;
  for (const auto& point : points)
    *squares += std::pow((solution * stretched(point, coulomb) - point.displacement) / uncertainty(point), 2);
  return solution;
}

}  // namespace

double SlidingCurve::at(double velocity) const {
  return creeping - rise * std::expm1(-velocity / rise_velocity) + viscous * velocity;
}

SlidingCurve fit_sliding_curve(const std::vector<SteadyPoint>& points) {
  if (points.size() < 5)
    throw NotDetermined(fmt::format(
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
  SlidingCurve curve{solution[0], solution[1], rise_velocity, solution[2],
                     std::sqrt(squares / static_cast<double>(points.size()))};
  if (!(curve.creeping > 0.0 && curve.rise >= 0.0 && curve.viscous >= 0.0))
    throw NotDetermined(
        fmt::format("steady friction: found a curve that falls ({:.1f} N creeping, {:.1f} N rise, {:.0f} N s/m); "
                    "expected friction that grows with the speed",
                    curve.creeping, curve.rise, curve.viscous));
  return curve;
}

double PreslidingCurve::displacement(bool same_direction, double force) const {
  return stretched({same_direction, force, 0.0}, coulomb) / stiffness;
}

PreslidingCurve fit_presliding_curve(const std::vector<PreslidingPoint>& points) {
  const auto same =
      std::count_if(points.begin(), points.end(), [](const PreslidingPoint& point) { return point.same_direction; });
  const auto opposite = static_cast<std::ptrdiff_t>(points.size()) - same;
  if (same < 2 || opposite < 2)
    throw NotDetermined(
        fmt::format("presliding: found {} points loaded in the direction of the motion before and {} against it; "
                    "expected at least 2 of each",
                    same, opposite));
  // Against the motion before, any force the contact carries is below Coulomb friction; with it, below twice that.
  double largest = 0.0;
  for (const auto& point : points) largest = std::max(largest, point.same_direction ? 0.5 * point.force : point.force);
  double squares = 0.0;
  const double coulomb = argument_of_minimum(1.001 * largest, 5.0 * largest, [&](double candidate) {
    double cost = 0.0;
    compliance(points, candidate, &cost);
    return cost;
  });
  const double solution = compliance(points, coulomb, &squares);
  return {1.0 / solution, coulomb, std::sqrt(squares / static_cast<double>(points.size()))};
}

sim::MaxwellSlip::Parameters friction_elements(const SlidingCurve& sliding, const PreslidingCurve& presliding,
                                               double force, double displacement) {
  // Shares of the Coulomb friction at the corners of a polygon in the hyperbola, evenly in the logarithm of what is
  // left up to 95 %, as far as Tab 5.3 reaches; the last element slips where the tangent there reaches the whole.
  constexpr int count = 10;
  constexpr double left_at_last_corner = 0.05;
  const double coulomb = force * sliding.creeping;
  const double half = displacement * presliding.coulomb / presliding.stiffness;  // m, where half of it acts
  std::array<double, count + 1> share{}, place{};
  for (std::size_t i = 1; i < count; ++i) {
    share[i] = 1.0 - std::pow(left_at_last_corner, static_cast<double>(i) / (count - 1));
    place[i] = half * share[i] / (1.0 - share[i]);
  }
  share[count] = 1.0;
  place[count] = half * (2.0 - left_at_last_corner) / left_at_last_corner;

  sim::MaxwellSlip::Parameters p;
  std::array<double, count + 1> slope{};  // of the polygon up to corner i + 1; none beyond the last
  for (std::size_t i = 0; i < count; ++i) slope[i] = coulomb * (share[i + 1] - share[i]) / (place[i + 1] - place[i]);
  for (std::size_t i = 0; i < count; ++i) {
    p.stiffness.push_back(slope[i] - slope[i + 1]);
    p.level.push_back(p.stiffness.back() * place[i + 1]);
  }
  p.viscous = force * sliding.viscous;
  p.rise = force * sliding.rise;
  p.rise_velocity = sliding.rise_velocity;
  return p;
}

}  // namespace stiction::host
