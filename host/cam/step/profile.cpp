#include "host/cam/step/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/cam/law.hpp"

namespace stiction::host::step {
namespace {

// Lines between the samples of a path are this near to it, m: candidates that are nearer to one another are refined.
constexpr double near_one_another = 20e-6;
// Points of a roller that follow each other differ by no more than this in the cam's angle, rad, but at a vertex.
constexpr double widest_advance = 0.07;

struct Candidate {
  double radius = infinity;
  int roller = -1;
  double psi = 0.0;
};

// The two nearest of an angle; more never are within `near_one_another` of each other but in a point.
struct Candidates {
  Candidate first, second;

  void add(const Candidate& c) {
    if (c.radius < first.radius)
      second = first, first = c;
    else if (c.radius < second.radius)
      second = c;
  }
};

class Cutter {
 public:
  Cutter(const StepMechanism& mechanism, const SampledLift& lift, int row, int points)
      : mechanism_(mechanism), lift_(lift), row_(row), step_(turn / points), found_(static_cast<std::size_t>(points)) {}

  StepProfile profile() {
    for (int k = 0; k < mechanism_.rollers; ++k) add_path(k);
    StepProfile profile;
    profile.row = row_;
    for (std::size_t j = 0; j < found_.size(); ++j) profile.points.push_back(chosen(j));
    add_vertices(profile);
    const auto by_radius = [](const ProfilePoint& p, const ProfilePoint& q) { return p.radius < q.radius; };
    const auto [low, high] = std::minmax_element(profile.points.begin(), profile.points.end(), by_radius);
    profile.least_radius = low->radius, profile.largest_radius = high->radius;
    for (const auto& vertex : profile.vertices) {
      profile.least_radius = std::min(profile.least_radius, vertex.radius);
      profile.largest_radius = std::max(profile.largest_radius, vertex.radius);
    }
    return profile;
  }

 private:
  double base(int roller) const { return mechanism_.base(row_) + roller * mechanism_.pitch(); }

  // All angles that the contacts of a roller pass in a turn, with the radius on a line between two samples.
  void add_path(int roller) {
    const double c = mechanism_.roller_radius;
    Point last;
    double last_angle = 0.0;
    for (std::size_t i = 0; i < lift_.psi.size(); ++i) {
      const Point contact = roller_at(mechanism_, base(roller), lift_.psi[i], lift_.states[i]).contact(c);
      const double angle =
          i == 0 ? sim::angle_of(contact) : last_angle + around_zero(sim::angle_of(contact) - last_angle);
      if (i > 0) add_line(roller, i, last, contact, last_angle, angle);
      last = contact, last_angle = angle;
    }
  }

  void add_line(int roller, std::size_t i, Point from, Point to, double begin, double end) {
    const double low = std::min(begin, end), high = std::max(begin, end);
    for (double j = std::ceil(low / step_); j * step_ < high; ++j) {
      // Where the ray of that angle meets the line.
      const Point ray = sim::in_direction(1.0, j * step_);
      const double across = cross(from, ray), other = cross(to, ray);
      const double share = across / (across - other);
      const double radius = dot(from + share * (to - from), ray);
      const auto count = static_cast<long>(found_.size());
      const long at = static_cast<long>(j) % count;
      found_[static_cast<std::size_t>(at < 0 ? at + count : at)].add(
          {radius, roller, lift_.psi[i - 1] + share * (lift_.psi[i] - lift_.psi[i - 1])});
    }
  }

  // The place of a path at exactly that angle, by Newton's method from a place near it.
  ProfilePoint refined(const Candidate& candidate, double angle) const {
    const double c = mechanism_.roller_radius;
    ProfilePoint point{.angle = angle, .roller = candidate.roller, .psi = candidate.psi};
    RollerPoint at;
    Point contact;
    for (int k = 0; k < 3; ++k) {
      at = roller_at(mechanism_, base(candidate.roller), point.psi, lift_.lift->at(point.psi));
      contact = at.contact(c);
      if (k == 2) break;
      const double turning = cross(contact, at.contact_rate(c)) / std::norm(contact);
      const double move = around_zero(angle - sim::angle_of(contact)) / turning;
      if (!(std::fabs(move) < 0.01)) break;
      point.psi = std::clamp(point.psi + move, 0.0, turn);
    }
    point.radius = sim::magnitude(contact);
    point.normal = at.normal;
    point.curvature = at.curvature / (1.0 - c * at.curvature);
    return point;
  }

  ProfilePoint chosen(std::size_t j) const {
    const double angle = static_cast<double>(j) * step_;
    const auto& [first, second] = found_[j];
    if (first.roller < 0)
      throw sim::cam::CamError(fmt::format(
          "found no roller of row {} that leaves the profile at {:.4g}°; expected one at every angle of the cam",
          row_ + 1, angle * 360.0 / turn));
    ProfilePoint point = refined(first, angle);
    if (second.radius > first.radius + near_one_another) return point;
    const ProfilePoint other = refined(second, angle);
    return other.radius < point.radius ? other : point;
  }

  // How far along the carousel's whole way the roller is: it goes on as the next one after a turn.
  bool follows(const ProfilePoint& from, const ProfilePoint& to) const {
    const double sense = mechanism_.against ? -1.0 : 1.0;
    const auto pitches = static_cast<int>(std::lround(sense * lift_.lift->stroke() / mechanism_.pitch()));
    double advance = to.psi - from.psi;
    int roller = to.roller;
    if (advance < -turn / 2) advance += turn, roller -= pitches;
    if (advance > turn / 2) advance -= turn, roller += pitches;
    return (roller - from.roller) % mechanism_.rollers == 0 && std::fabs(advance) < widest_advance;
  }

  // The corner between two points by two different parts: where their radii are equal.
  void add_vertices(StepProfile& profile) const {
    const auto count = profile.points.size();
    for (std::size_t j = 0; j < count; ++j) {
      const ProfilePoint& before = profile.points[(j + count - 1) % count];
      const ProfilePoint& behind = profile.points[j];
      if (follows(before, behind)) continue;
      double low = behind.angle - step_, high = behind.angle;
      ProfilePoint left = before, right = behind;
      for (int k = 0; k < 30; ++k) {
        const double middle = 0.5 * (low + high);
        left = refined({0.0, before.roller, left.psi}, middle);
        right = refined({0.0, behind.roller, right.psi}, middle);
        (left.radius < right.radius ? low : high) = middle;
      }
      const double angle = 0.5 * (low + high);
      const bool peak = cross(left.normal, right.normal) > 0.0;
      profile.vertices.push_back({wrapped(angle), std::min(left.radius, right.radius), j, peak});
    }
  }

  const StepMechanism& mechanism_;
  const SampledLift& lift_;
  int row_;
  double step_;
  std::vector<Candidates> found_;
};

}  // namespace

double StepProfile::step() const { return turn / static_cast<double>(points.size()); }

bool StepProfile::has_corner(double angle, double distance) const {
  return std::any_of(vertices.begin(), vertices.end(), [&](const ProfileVertex& vertex) {
    return std::fabs(around_zero(vertex.angle - angle)) <= distance;
  });
}

double StepProfile::radius_at(double angle) const {
  const double at = wrapped(angle) / step();
  const auto j = static_cast<std::size_t>(at) % points.size();
  const ProfilePoint& p = points[j];
  const ProfilePoint& q = points[(j + 1) % points.size()];
  double begin = p.angle, end = p.angle + step(), low = p.radius, high = q.radius;
  for (const auto& vertex : vertices)
    if (vertex.behind == (j + 1) % points.size()) {
      const double corner = begin + wrapped(vertex.angle - begin);
      if (wrapped(angle) < corner)
        end = corner, high = vertex.radius;
      else
        begin = corner, low = vertex.radius;
    }
  return end > begin ? low + (high - low) * (wrapped(angle) - begin) / (end - begin) : low;
}

SampledLift sampled(const StepLift& lift, int steps) {
  SampledLift all;
  all.lift = &lift;
  for (int k = 0; k <= steps; ++k) {
    all.psi.push_back(k == steps ? turn : turn * k / steps);
    all.states.push_back(lift.at(all.psi.back()));
  }
  return all;
}

StepProfile cut_profile(const StepMechanism& mechanism, const SampledLift& lift, int row, int points) {
  return Cutter(mechanism, lift, row, points).profile();
}

}  // namespace stiction::host::step
