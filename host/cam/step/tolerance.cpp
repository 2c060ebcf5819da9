#include "host/cam/step/tolerance.hpp"

#include <algorithm>
#include <cmath>

namespace stiction::host::step {
namespace {

// Where a contact's normal points to in the frame that rests: the line from the cam to the carousel is the x axis.
Point resting_normal(const Contact& contact, double psi) { return contact.normal * std::polar(1.0, -psi); }
// From the carousel's axis to the roller.
Point arm_direction(const Contact& contact) { return -std::polar(1.0, -contact.arm_angle); }

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
                     const std::vector<ContactSet>& sets, const Deviation& by) {
  StepMechanism built = mechanism;
  built.arm += by.arm;
  built.roller_radius += by.roller;
  double peak = 0.0;
  for (const ContactSet& set : sets) {
    ContactSet moved = set;
    for (Contact& contact : moved.contacts) contact.gap += gap_change(contact, set.psi, by);
    for (const ContactForce& each : forces_at(built, lift, load, moved).contacts) peak = std::max(peak, each.pressure);
  }
  return peak;
}

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
  // A sixteenth of the turn's places, and those around the peak: the corners do not move it far.
  std::vector<ContactSet> some;
  for (std::size_t k = 0; k < sets.size(); k += 16) some.push_back(sets[k]);
  result.pressure = {infinity, 0.0};
  for (unsigned corner = 0; corner < 32; ++corner) {
    std::array<double, 5> by{};
    for (std::size_t k = 0; k < 5; ++k) by[k] = (corner >> k & 1u) != 0 ? widths[k] : -widths[k];
    const double peak = peak_pressure(mechanism, lift, load, some, deviation_of(by));
    result.pressure = {std::min(result.pressure.low, peak), std::max(result.pressure.high, peak)};
  }
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
