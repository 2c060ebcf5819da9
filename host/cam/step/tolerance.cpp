#include "host/cam/step/tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stiction::host::step {
namespace {

// Where a contact's normal points to in the frame that rests: the line from the cam to the carousel is the x axis.
Point resting_normal(const Contact& contact, double psi) { return contact.normal * sim::in_direction(1.0, -psi); }
// From the carousel's axis to the roller.
Point arm_direction(const Contact& contact) { return -sim::in_direction(1.0, -contact.arm_angle); }

std::array<double, 5> half_widths(const StepTolerances& t) {
  return {t.axis_distance, t.roller, t.arm, t.profile, t.preload};
}
Deviation deviation_of(const std::array<double, 5>& by) { return {by[0], by[1], by[2], by[3], by[4]}; }

// Sensitivities of the gap in the order of tolerance_names.
std::array<double, 5> sensitivities(const Contact& contact, double psi) {
  std::array<double, 5> all{};
  for (std::size_t k = 0; k < 5; ++k) {
    std::array<double, 5> unit{};
    unit[k] = 1.0;
    all[k] = gap_change(contact, psi, deviation_of(unit));
  }
  return all;
}

// What the first order leaves out, m.
double remainder_of(const Contact& contact, double psi, const StepTolerances& t, double roller_radius) {
  const Point n = resting_normal(contact, psi);
  const double along =
      std::fabs(n.imag()) * (t.axis_distance + t.preload) + std::fabs(cross(n, arm_direction(contact))) * t.arm;
  const double pitch_curvature = contact.curvature / (1.0 + roller_radius * contact.curvature);
  return 0.5 * along * along * std::fabs(pitch_curvature);
}

}  // namespace

double gap_change(const Contact& contact, double psi, const Deviation& by) {
  const Point n = resting_normal(contact, psi);
  return -(by.axis_distance - by.preload) * n.real() - by.arm * dot(n, arm_direction(contact)) - by.roller - by.profile;
}

Range play_at(const ContactSet& set, const StepTolerances& tolerances, double nearer, double roller_radius) {
  const Contact* up = set.pushing(1);
  const Contact* down = set.pushing(-1);
  if (up == nullptr || down == nullptr) return {std::nan(""), std::nan("")};
  double middle = 0.0, half = 0.0;
  std::array<double, 5> sum{};
  for (const Contact* contact : {up, down}) {
    const double lever = std::fabs(contact->push);
    middle += (contact->gap + nearer * resting_normal(*contact, set.psi).real()) / lever;
    half += remainder_of(*contact, set.psi, tolerances, roller_radius) / lever;
    const auto own = sensitivities(*contact, set.psi);
    for (std::size_t k = 0; k < 5; ++k) sum[k] += own[k] / lever;
  }
  const auto widths = half_widths(tolerances);
  for (std::size_t k = 0; k < 5; ++k) half += std::fabs(sum[k]) * widths[k];
  return {middle - half, middle + half};
}

double peak_pressure(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                     const std::vector<ContactSet>& sets, const Deviation& by, const std::vector<double>& more) {
  StepMechanism built = mechanism;
  built.arm += by.arm;
  built.roller_radius += by.roller;
  double peak = 0.0;
  std::size_t next = 0;
  for (const ContactSet& set : sets) {
    ContactSet moved = set;
    for (Contact& contact : moved.contacts) {
      contact.gap += gap_change(contact, set.psi, by);
      if (!more.empty()) contact.gap += more[next++];
    }
    for (const ContactForce& each : forces_at(built, lift, load, moved).contacts) peak = std::max(peak, each.pressure);
  }
  return peak;
}

namespace {

// What the first order leaves out of each gap, all contacts of `sets` in their order, times `sign`.
std::vector<double> remainders(const std::vector<ContactSet>& sets, const StepTolerances& tolerances,
                               double roller_radius, double sign) {
  std::vector<double> all;
  for (const ContactSet& set : sets)
    for (const Contact& contact : set.contacts)
      all.push_back(sign * remainder_of(contact, set.psi, tolerances, roller_radius));
  return all;
}

Deviation corner_of(unsigned corner, const std::array<double, 5>& widths) {
  std::array<double, 5> by{};
  for (std::size_t k = 0; k < 5; ++k) by[k] = (corner >> k & 1u) != 0 ? widths[k] : -widths[k];
  return deviation_of(by);
}

// The lowest and the highest peak of all corners of the tolerances, found on some places of the turn and computed on
// all of them. Between corners the forces are monotonous but for levers, normals and curvatures, which change by no
// more than the tolerances over the shortest length of the mechanism, the roller's radius: that share is added.
Range peaks_of_corners(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                       const std::vector<ContactSet>& sets, const std::vector<ContactSet>& some,
                       const StepTolerances& tolerances) {
  const auto widths = half_widths(tolerances);
  unsigned lowest = 0, highest = 0;
  Range found{infinity, -infinity};
  for (unsigned corner = 0; corner < 32; ++corner) {
    const double peak = peak_pressure(mechanism, lift, load, some, corner_of(corner, widths));
    if (peak < found.low) found.low = peak, lowest = corner;
    if (peak > found.high) found.high = peak, highest = corner;
  }
  const auto enclosed = [&](unsigned corner, double sign) {
    return peak_pressure(mechanism, lift, load, sets, corner_of(corner, widths),
                         remainders(sets, tolerances, mechanism.roller_radius, sign));
  };
  const double share = std::accumulate(widths.begin(), widths.end(), 0.0) / mechanism.roller_radius;
  return {enclosed(lowest, 1.0) * (1.0 - share), enclosed(highest, -1.0) * (1.0 + share)};
}

}  // namespace

ToleranceResult tolerance_of(const StepMechanism& mechanism, const StepLift& lift, const StepLoad& load,
                             const std::vector<ContactSet>& sets, const StepTolerances& tolerances) {
  ToleranceResult result;
  result.play = {infinity, -infinity};
  result.play_width = {infinity, 0.0};
  std::size_t widest = 0;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const Range play = play_at(sets[k], tolerances, load.preload, mechanism.roller_radius);
    if (std::isnan(play.low)) continue;
    result.play = {std::min(result.play.low, play.low), std::max(result.play.high, play.high)};
    result.play_width.low = std::min(result.play_width.low, play.width());
    if (play.width() > result.play_width.high) result.play_width.high = play.width(), widest = k;
  }
  result.widest_psi = sets[widest].psi;
  const auto widths = half_widths(tolerances);
  for (std::size_t k = 0; k < 5; ++k) {
    double sum = 0.0;
    for (const int way : {1, -1})
      if (const Contact* contact = sets[widest].pushing(way))
        sum += sensitivities(*contact, sets[widest].psi)[k] / std::fabs(contact->push);
    result.play_share[k] = std::fabs(sum) * widths[k];
  }
  // Places enough to tell the corners apart.
  const std::size_t each = std::max<std::size_t>(1, sets.size() / 225);
  std::vector<ContactSet> some;
  for (std::size_t k = 0; k < sets.size(); k += each) some.push_back(sets[k]);
  result.pressure = peaks_of_corners(mechanism, lift, load, sets, some, tolerances);
  for (std::size_t k = 0; k < 5; ++k) {
    std::array<double, 5> by{};
    by[k] = widths[k];
    const double more = peak_pressure(mechanism, lift, load, some, deviation_of(by));
    by[k] = -widths[k];
    result.pressure_share[k] = 0.5 * std::fabs(more - peak_pressure(mechanism, lift, load, some, deviation_of(by)));
  }
  return result;
}

}  // namespace stiction::host::step
