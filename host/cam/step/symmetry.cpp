#include "host/cam/step/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiction::host::step {
namespace {

bool near_corner(const StepProfile& profile, double angle) { return profile.has_corner(angle, 3.0 * profile.step()); }

// By the cubic polynomial through four points: the error is far below a nanometre where nothing jumps.
double smooth_radius(const StepProfile& profile, double angle) {
  const auto count = static_cast<long>(profile.points.size());
  const double at = wrapped(angle) / profile.step();
  const double t = at - std::floor(at);
  const auto radius = [&](long k) {
    const long j = (static_cast<long>(std::floor(at)) + k + count) % count;
    return profile.points[static_cast<std::size_t>(j)].radius;
  };
  return -t * (t - 1) * (t - 2) / 6 * radius(-1) + (t + 1) * (t - 1) * (t - 2) / 2 * radius(0) -
         (t + 1) * t * (t - 2) / 2 * radius(1) + (t + 1) * t * (t - 1) / 6 * radius(2);
}

// Largest difference over every `each`th point.
double distance_about(double axis, const std::array<StepProfile, 2>& profiles, std::size_t each) {
  const auto& [first, second] = profiles;
  double largest = 0.0;
  for (std::size_t j = 0; j < first.points.size(); j += each) {
    const ProfilePoint& point = first.points[j];
    const double mirrored = 2.0 * axis - point.angle;
    if (near_corner(first, point.angle) || near_corner(second, mirrored)) continue;
    largest = std::max(largest, std::fabs(point.radius - smooth_radius(second, mirrored)));
  }
  return largest;
}

// The nearest axis between `low` and `high`, rad: the distance grows to both sides of it, so thirds; then the multiple
// of half a step beside it, where that is not worse by a rounding.
Symmetry nearest_between(double low, double high, const std::array<StepProfile, 2>& profiles) {
  const std::size_t each = std::max<std::size_t>(1, profiles[0].points.size() / 240);
  for (int k = 0; k < 70; ++k) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    if (distance_about(left, profiles, each) < distance_about(right, profiles, each))
      high = right;
    else
      low = left;
  }
  const double axis = 0.5 * (low + high), step = 0.5 * profiles[0].step();
  Symmetry best{axis, distance_about(axis, profiles, 1), {}};
  const double rounded = step * std::round(axis / step);
  if (const double d = distance_about(rounded, profiles, 1); d <= best.distance) best = {rounded, d, {}};
  best.axis -= 0.5 * turn * std::floor(best.axis / (0.5 * turn));
  return best;
}

// How fast the radius changes at the most, m/rad.
double steepest(const StepProfile& profile) {
  double most = 0.0;
  for (const ProfilePoint& point : profile.points) {
    const Point round = Point(0.0, 1.0) * sim::in_direction(1.0, point.angle);
    const double along = std::fabs(dot(point.normal, sim::in_direction(1.0, point.angle)));
    most = std::max(most, point.radius * std::fabs(dot(point.normal, round)) / std::max(along, 1e-3));
  }
  return most;
}

}  // namespace

Symmetry symmetry_of(const std::array<StepProfile, 2>& profiles) {
  constexpr int coarse = 360;
  const auto count = profiles[0].points.size();
  const double spacing = 0.5 * turn / coarse;
  std::vector<double> distances;
  for (int k = 0; k < coarse; ++k)
    distances.push_back(distance_about(k * spacing, profiles, std::max<std::size_t>(1, count / 120)));
  // An axis that holds lies within half a spacing of one that is off by no more than the mirrored radius changes there.
  const double least = *std::min_element(distances.begin(), distances.end());
  const double reach = std::max(least, steepest(profiles[1]) * spacing);
  Symmetry best{0.0, infinity, {}};
  for (int k = 0; k < coarse; ++k) {
    const auto at = [&](int j) { return distances[static_cast<std::size_t>((j + coarse) % coarse)]; };
    if (at(k) > reach || at(k) > at(k - 1) || at(k) >= at(k + 1)) continue;
    const Symmetry found = nearest_between((k - 1) * spacing, (k + 1) * spacing, profiles);
    if (found.distance <= mirrored_within) best.axes.push_back(found.axis);
    if (found.distance < best.distance) best.axis = found.axis, best.distance = found.distance;
  }
  std::sort(best.axes.begin(), best.axes.end());
  // The first of several that hold, whichever is the nearest by a rounding.
  if (best.holds()) best.axis = best.axes.front();
  return best;
}

}  // namespace stiction::host::step
