#include "host/cam/step/outline.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host::step {
namespace {

// The points of one part of the outline, its corners at both ends.
using Part = std::vector<CurveNode>;

CurveNode node_of(const ProfilePoint& point, double angle) {
  const Point along = Point(0.0, -1.0) * point.normal, round = Point(0.0, 1.0) * sim::in_direction(1.0, point.angle);
  return {angle, point.place(), along * (point.radius / dot(along, round))};
}

// A corner has the slope that its neighbour's parabola has there.
CurveNode corner_node(const ProfileVertex& vertex, double angle, const CurveNode& near, const CurveNode& next) {
  const double share = (angle - near.angle) / (next.angle - near.angle);
  return {angle, vertex.place(), near.slope + share * (next.slope - near.slope)};
}

std::vector<Part> parts_of(const StepProfile& profile) {
  const auto count = profile.points.size();
  const double step = profile.step();
  if (profile.vertices.empty()) {
    Part whole;
    for (std::size_t j = 0; j <= count; ++j)
      whole.push_back(node_of(profile.points[j % count], static_cast<double>(j) * step));
    return {whole};
  }
  std::vector<Part> parts;
  for (std::size_t v = 0; v < profile.vertices.size(); ++v) {
    const ProfileVertex& from = profile.vertices[v];
    const ProfileVertex& to = profile.vertices[(v + 1) % profile.vertices.size()];
    std::size_t points = (to.behind + count - from.behind) % count;
    if (points == 0) points = count;
    Part part;
    const double first = profile.points[from.behind].angle;
    for (std::size_t k = 0; k < points; ++k)
      part.push_back(node_of(profile.points[(from.behind + k) % count], first + static_cast<double>(k) * step));
    const double last = part.back().angle;
    const CurveNode end = corner_node(to, last + wrapped(to.angle - last), part.back(),
                                      part.size() > 1 ? part[part.size() - 2] : part.back());
    const CurveNode begin =
        corner_node(from, first - wrapped(first - from.angle), part.front(), part.size() > 1 ? part[1] : part.front());
    if (end.angle - last > 1e-9) part.push_back(end);
    if (first - begin.angle > 1e-9) part.insert(part.begin(), begin);
    parts.push_back(std::move(part));
  }
  return parts;
}

// The circle through three points.
struct Circle {
  Point centre;
  double radius = 0.0;
  bool straight = false;
};
Circle circle_through(Point a, Point b, Point c) {
  const double twice = 2.0 * cross(b - a, c - a);
  if (std::fabs(twice) < 1e-18) return {{}, 0.0, true};
  const Point ab = b - a, ac = c - a;
  const Point centre = a + Point(0.0, 1.0) * (ab * std::norm(ac) - ac * std::norm(ab)) / twice;
  return {centre, sim::magnitude(centre - a), false};
}

bool arc_fits(const Part& part, std::size_t from, std::size_t to, double chord) {
  const Circle circle = circle_through(part[from].place, part[(from + to) / 2].place, part[to].place);
  for (std::size_t k = from + 1; k < to; ++k) {
    const Point p = part[k].place;
    const double off = circle.straight ? std::fabs(cross(part[to].place - part[from].place, p - part[from].place)) /
                                             sim::magnitude(part[to].place - part[from].place)
                                       : std::fabs(sim::magnitude(p - circle.centre) - circle.radius);
    if (off > chord) return false;
  }
  // Longer than a quarter of a turn an arc is split, so that no reader doubts its side.
  return part[to].angle - part[from].angle < 0.25 * turn;
}

double bulge_of(Point a, Point middle, Point b) {
  const Circle circle = circle_through(a, middle, b);
  if (circle.straight) return 0.0;
  // tan(x / 2) = sin x / (1 + cos x) of half the angle of the arc.
  const double sine = std::min(1.0, 0.5 * sim::magnitude(b - a) / circle.radius);
  return std::copysign(sine / (1.0 + std::sqrt(1.0 - sine * sine)), cross(middle - a, b - middle));
}

bool curve_fits(const Part& part, std::size_t from, std::size_t to, double chord) {
  for (std::size_t k = from + 1; k < to; ++k)
    if (sim::magnitude(on_curve(part[from], part[to], part[k].angle) - part[k].place) > chord) return false;
  return true;
}

// The farthest point that one element still fits, by steps that double.
template <class Fits>
std::size_t farthest(const Part& part, std::size_t from, Fits fits) {
  std::size_t to = from + 1;
  for (std::size_t step = 1; step > 0;) {
    const std::size_t next = std::min(to + step, part.size() - 1);
    if (next > to && fits(from, next))
      to = next, step *= 2;
    else
      step /= 2;
  }
  return to;
}

}  // namespace

Point on_curve(const CurveNode& from, const CurveNode& to, double angle) {
  const double h = to.angle - from.angle, t = (angle - from.angle) / h;
  const double u = t * t * (3.0 - 2.0 * t);
  return (1.0 - u) * from.place + u * to.place + h * t * (1.0 - t) * ((1.0 - t) * from.slope - t * to.slope);
}

std::vector<ArcCorner> arcs_of(const StepProfile& profile, double chord) {
  std::vector<ArcCorner> corners;
  for (const Part& part : parts_of(profile))
    for (std::size_t from = 0; from + 1 < part.size();) {
      // Half of the distance is for what lies between the points.
      const auto to =
          farthest(part, from, [&](std::size_t a, std::size_t b) { return arc_fits(part, a, b, 0.5 * chord); });
      const Point middle = to > from + 1 ? part[(from + to) / 2].place
                                         : on_curve(part[from], part[to], 0.5 * (part[from].angle + part[to].angle));
      corners.push_back({part[from].place, bulge_of(part[from].place, middle, part[to].place)});
      from = to;
    }
  return corners;
}

std::vector<std::vector<CurveNode>> curves_of(const StepProfile& profile, double chord) {
  std::vector<std::vector<CurveNode>> curves;
  for (const Part& part : parts_of(profile)) {
    std::vector<CurveNode> nodes{part.front()};
    for (std::size_t from = 0; from + 1 < part.size();) {
      from = farthest(part, from, [&](std::size_t a, std::size_t b) { return curve_fits(part, a, b, 0.5 * chord); });
      nodes.push_back(part[from]);
    }
    curves.push_back(std::move(nodes));
  }
  return curves;
}

}  // namespace stiction::host::step
