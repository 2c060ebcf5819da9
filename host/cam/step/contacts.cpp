#include "host/cam/step/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiction::host::step {
namespace {

// Beyond this the profile is cut below a roller's own contact by so much that nothing near it touches, m.
constexpr double deepest_cut = 3e-3;

// The smallest value of the parabola through three values one step apart, the middle one the smallest.
double lowest_of_parabola(double before, double middle, double behind) {
  const double bend = before - 2.0 * middle + behind;
  if (middle > before || middle > behind || !(bend > 0.0)) return middle;
  const double slope = behind - before;
  return middle - slope * slope / (8.0 * bend);
}

}  // namespace

double Contact::pressure_angle() const { return sim::arc_cosine(std::min(1.0, std::fabs(push))); }

const Contact* ContactSet::pushing(int way) const {
  for (const Contact& contact : contacts)
    if (contact.needed && (contact.push > 0.0) == (way > 0)) return &contact;
  return nullptr;
}

ContactSearch::ContactSearch(const StepMechanism& mechanism, const StepLift& lift,
                             const std::array<StepProfile, 2>& profiles, double lead_in)
    : mechanism_(mechanism), lift_(lift), profiles_(profiles), lead_in_(lead_in) {
  for (std::size_t cam = 0; cam < 2; ++cam)
    for (const ProfilePoint& point : profiles_[cam].points) places_[cam].push_back(point.place());
}

double ContactSearch::gap_of(int cam, const RollerPoint& at, double largest_gap) const {
  const auto& profile = profiles_[static_cast<std::size_t>(cam)];
  const auto& places = places_[static_cast<std::size_t>(cam)];
  const double c = mechanism_.roller_radius;
  const double distance = sim::magnitude(at.centre);
  if (distance > profile.largest_radius + c + largest_gap) return infinity;
  const Point own = at.contact(c);
  // Where the roller would touch if its own part of the profile were there.
  if (sim::magnitude(own) - profile.radius_at(sim::angle_of(own)) > deepest_cut) return infinity;
  const auto count = static_cast<long>(places.size());
  const double step = profile.step();
  // A roller that is this near to a corner is no farther from its own contact there than sqrt(2 c gap), by its
  // curvature; twice that and half a millimetre hold what profiles bend besides.
  const double half = (2.0 * std::sqrt(2.0 * c * largest_gap) + 0.5e-3) / sim::magnitude(own);
  const auto first = static_cast<long>(std::floor((sim::angle_of(own) - half) / step));
  const auto last = static_cast<long>(std::ceil((sim::angle_of(own) + half) / step));
  const auto square = [&](long j) {
    const long k = j % count;
    return std::norm(at.centre - places[static_cast<std::size_t>(k < 0 ? k + count : k)]);
  };
  double least = infinity;
  long nearest = first;
  for (long j = first; j <= last; ++j)
    if (const double d = square(j); d < least) least = d, nearest = j;
  bool corner = false;
  for (const ProfileVertex& vertex : profile.vertices) {
    const double near = around_zero(vertex.angle - static_cast<double>(nearest) * step);
    corner = corner || std::fabs(near) < 1.5 * step;
    least = std::min(least, std::norm(at.centre - vertex.place()));
  }
  if (!corner) least = std::min(least, lowest_of_parabola(square(nearest - 1), square(nearest), square(nearest + 1)));
  return std::sqrt(least) - c;
}

ContactSet ContactSearch::at(double psi, double largest_gap) const {
  ContactSet set;
  set.psi = psi;
  const LiftState lift = lift_.at(psi);
  const double c = mechanism_.roller_radius;
  for (int cam = 0; cam < 2; ++cam)
    for (int k = 0; k < mechanism_.rollers; ++k) {
      const RollerPoint p = roller_at(mechanism_, mechanism_.base(cam) + k * mechanism_.pitch(), psi, lift);
      const double gap = gap_of(cam, p, largest_gap);
      if (gap > largest_gap) continue;
      set.contacts.push_back({cam, k, gap, p.push(psi), around_zero(p.arm_angle), p.contact(c), p.normal,
                              p.curvature / (1.0 - c * p.curvature), false});
    }
  const auto led_in = [&](const Contact& contact) {
    const auto& profile = profiles_[static_cast<std::size_t>(contact.cam)];
    return lead_in_ > 0.0 && profile.has_corner(sim::angle_of(contact.place), lead_in_);
  };
  for (const int way : {1, -1}) {
    Contact* best = nullptr;
    for (Contact& contact : set.contacts) {
      if (contact.gap > contact_gap || way * contact.push <= 0.0) continue;
      const bool smaller = best != nullptr && way * contact.push > way * best->push;
      if (best == nullptr || (led_in(contact) == led_in(*best) ? smaller : led_in(*best))) best = &contact;
    }
    if (best != nullptr) best->needed = true;
  }
  return set;
}

Coupling couple(const StepProfile& profile, const ContactSearch& search) {
  Coupling coupling;
  const auto count = profile.points.size();
  coupling.needed.assign(count, true);
  coupling.others.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    const ProfilePoint& point = profile.points[j];
    const ContactSet set = search.at(point.psi);
    for (const Contact& contact : set.contacts)
      if (contact.cam == profile.row && contact.roller == point.roller)
        coupling.needed[j] = contact.needed;
      else
        coupling.others[j].push_back(contact);
  }
  // From a needed point on, so that no arc is cut at the seam.
  const auto start = static_cast<std::size_t>(std::find(coupling.needed.begin(), coupling.needed.end(), true) -
                                              coupling.needed.begin());
  for (std::size_t k = 0; k < count && start < count; ++k) {
    const std::size_t j = (start + k) % count, before = (start + k + count - 1) % count;
    const double angle = static_cast<double>(start + k) * profile.step();
    if (coupling.needed[j]) continue;
    if (coupling.needed[before]) coupling.redundant.push_back({angle, angle});
    coupling.redundant.back().end = angle;
  }
  for (ProfileArc& arc : coupling.redundant)
    if (arc.begin >= turn) arc.begin -= turn, arc.end -= turn;
  std::sort(coupling.redundant.begin(), coupling.redundant.end(),
            [](const ProfileArc& a, const ProfileArc& b) { return a.begin < b.begin; });
  return coupling;
}

}  // namespace stiction::host::step
