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

}  // namespace

Symmetry symmetry_of(const std::array<StepProfile, 2>& profiles) {
  constexpr int coarse = 360;
  const auto count = profiles[0].points.size();
  const double spacing = 0.5 * turn / coarse;
  Symmetry best{0.0, infinity};
  for (int k = 0; k < coarse; ++k)
    if (const double d = distance_about(k * spacing, profiles, std::max<std::size_t>(1, count / 120));
        d < best.distance)
      best = {k * spacing, d};
  // The distance grows to both sides of the axis: thirds.
  double low = best.axis - spacing, high = best.axis + spacing;
  for (int k = 0; k < 70; ++k) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    const std::size_t each = std::max<std::size_t>(1, count / 240);
    (distance_about(left, profiles, each) < distance_about(right, profiles, each) ? high : low) =
        distance_about(left, profiles, each) < distance_about(right, profiles, each) ? right : left;
  }
  best.axis = 0.5 * (low + high);
  // An axis on the grid is not worse by a rounding.
  const double step = 0.5 * profiles[0].step();
  const double rounded = step * std::round(best.axis / step);
  best.distance = distance_about(best.axis, profiles, 1);
  if (const double d = distance_about(rounded, profiles, 1); d <= best.distance) best = {rounded, d};
  best.axis -= 0.5 * turn * std::floor(best.axis / (0.5 * turn));
  return best;
}

}  // namespace stiction::host::step
