// Both cams of a mechanism once more, by a way that shares nothing with the code under test: discs of a turn against
// rays from the cam's axis, and contacts as discs that come near to the ends of those rays. Slow and blunt; for tests.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/host/cam/step/step_case.hpp"

namespace stiction::host::step {

// A disc that touches a cam.
struct RayContact {
  int cam = 0, roller = 0;
  double angle = 0.0;  // rad, of the ray that is the nearest to the disc
  double push = 0.0;   // lever of its force about the carousel over the arm, above 0 where it raises v
};

class RayCut {
 public:
  // Of `project` with that `lift`, by as many rays in a turn as `rays` and discs at as many cam angles as `discs`.
  RayCut(const StepProject& project, const StepLift& lift, int rays = 14400, int discs = 5760)
      : project_(project), lift_(lift) {
    for (auto& cam : radii_) cam.assign(static_cast<std::size_t>(rays), infinity);
    for (int j = 0; j < rays; ++j) directions_.push_back(std::polar(1.0, turn * j / rays));
    for (int k = 0; k < discs; ++k)
      for (int cam = 0; cam < 2; ++cam)
        for (int roller = 0; roller < project.mechanism.rollers; ++roller)
          cut(cam, centre(cam, roller, turn * k / discs));
  }

  // Discs within `gap`, m, of the rays' ends at the cam's angle `psi`, rad.
  std::vector<RayContact> contacts(double psi, double gap) const {
    std::vector<RayContact> found;
    for (int cam = 0; cam < 2; ++cam)
      for (int roller = 0; roller < project_.mechanism.rollers; ++roller) {
        const Point at = centre(cam, roller, psi);
        const auto& radii = radii_[static_cast<std::size_t>(cam)];
        const double c = project_.mechanism.roller_radius;
        if (is_behind(at)) continue;
        const double half = std::asin(c / std::abs(at));
        double least = infinity;
        std::size_t nearest = 0;
        for (double ray = std::arg(at) - half; ray <= std::arg(at) + half; ray += step())
          if (const double d = std::norm(at - radii[index(ray)] * directions_[index(ray)]); d < least)
            least = d, nearest = index(ray);
        if (std::sqrt(least) > c + gap) continue;
        const Point push = (at - radii[nearest] * directions_[nearest]) / std::sqrt(least);
        const Point arm = at - std::polar(project_.mechanism.axis_distance, psi);
        // The arm's angle v grows clockwise.
        found.push_back(
            {cam, roller, static_cast<double>(nearest) * step(), -(std::conj(arm) * push).imag() / std::abs(arm)});
      }
    return found;
  }

 private:
  double step() const { return turn / static_cast<double>(radii_[0].size()); }
  std::size_t index(double angle) const {
    const auto count = static_cast<long>(radii_[0].size());
    const long j = std::lround(angle / step()) % count;
    return static_cast<std::size_t>(j < 0 ? j + count : j);
  }

  // In the cam's frame, by the cosines of both triangles.
  Point centre(int cam, int roller, double psi) const {
    const StepMechanism& m = project_.mechanism;
    const double rest = m.dwell_position - (cam == 1 ? m.row_angle : 0.0) + roller * turn / m.rollers;
    const double v = rest + (m.against ? -1.0 : 1.0) * lift_.at(wrapped(psi)).way;
    return std::polar(1.0, psi) * Point(m.axis_distance - m.arm * std::cos(v), m.arm * std::sin(v));
  }

  // On the side of the carousel that is turned away from the cam.
  bool is_behind(Point at) const {
    const StepMechanism& m = project_.mechanism;
    return std::norm(at) > m.axis_distance * m.axis_distance + m.arm * m.arm;
  }

  void cut(int cam, Point at) {
    auto& radii = radii_[static_cast<std::size_t>(cam)];
    const double c = project_.mechanism.roller_radius, distance = std::abs(at), half = std::asin(c / distance);
    if (is_behind(at)) return;
    const auto low = static_cast<long>(std::ceil((std::arg(at) - half) / step()));
    const auto high = static_cast<long>(std::floor((std::arg(at) + half) / step()));
    for (long j = low; j <= high; ++j) {
      const std::size_t k = index(static_cast<double>(j) * step());
      const Point turned = at * std::conj(directions_[k]);
      radii[k] = std::min(radii[k], turned.real() - std::sqrt(std::max(0.0, c * c - turned.imag() * turned.imag())));
    }
  }

  const StepProject& project_;
  const StepLift& lift_;
  std::array<std::vector<double>, 2> radii_;
  std::vector<Point> directions_;  // of the rays
};

}  // namespace stiction::host::step
