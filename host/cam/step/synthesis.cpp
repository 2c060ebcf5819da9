#include "host/cam/step/synthesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stiction::host::step {
namespace {

using sim::cam::CamError;

// Rollers with so large a gap may still be pressed, m: what the preload closes and a roller gives, with every tolerance
// on the side that presses.
double gap_in_reach(const StepProject& project) {
  const StepTolerances& t = project.tolerances;
  if (!(project.load.stiffness > 0.0)) return contact_gap;
  return contact_gap + 2.0 * (project.load.preload + t.axis_distance + t.roller + t.arm + t.profile + t.preload);
}

std::vector<ContactSet> contacts_of(const ContactSearch& search, int steps, double gap) {
  std::vector<ContactSet> sets;
  for (int k = 0; k < steps; ++k) sets.push_back(search.at(turn * k / steps, gap));
  return sets;
}

void include(LeastRadii& least, double curvature, double angle, int cam) {
  const double radius = curvature == 0.0 ? infinity : 1.0 / std::fabs(curvature);
  if (curvature > 0.0 && radius < least.convex)
    least.convex = radius, least.convex_angle = angle, least.convex_cam = cam;
  if (curvature < 0.0 && radius < least.concave)
    least.concave = radius, least.concave_angle = angle, least.concave_cam = cam;
}

}  // namespace

ContactShares StepSynthesis::shares(const std::vector<ContactSet>& sets) const {
  ContactShares shares;
  const double one = 1.0 / static_cast<double>(sets.size());
  for (const ContactSet& set : sets) {
    const auto touching = std::count_if(set.contacts.begin(), set.contacts.end(),
                                        [](const Contact& contact) { return contact.gap <= contact_gap; });
    (touching == 2 ? shares.two : touching == 3 ? shares.three : shares.other) += one;
  }
  return shares;
}

StepLift lift_of(const StepProject& project, std::vector<std::string>& notes) {
  return project.measured ? lift_of(*project.measured, notes) : lift_of(*project.cam);
}

StepSynthesis synthesize(const StepProject& project) {
  std::vector<std::string> notes;
  StepLift lift = lift_of(project, notes);
  const StepMechanism& m = project.mechanism;
  const StepCount count = count_steps(m, lift);
  const SampledLift samples = sampled(lift, project.steps);
  const std::array<StepProfile, 2> cut{cut_profile(m, samples, 0, project.steps),
                                       cut_profile(m, samples, 1, project.steps)};
  require_buildable(m, samples, cut);
  StepSynthesis made{std::move(lift), count, cut, {}, {}, {}, {}, {}, {}, {}, std::move(notes)};
  const ContactSearch search(m, made.lift, made.cut, project.relief.lead_in);
  made.unrelieved = contacts_of(search, project.steps, contact_gap);
  require_held(m, made.unrelieved);
  for (std::size_t cam = 0; cam < 2; ++cam) made.couplings[cam] = couple(made.cut[cam], search);
  made.symmetry = symmetry_of(made.cut);
  relieve_again(made, project);
  return made;
}

void relieve_again(StepSynthesis& made, const StepProject& project) {
  const StepMechanism& m = project.mechanism;
  made.arcs = relief_arcs(made.cut, made.couplings, project.relief, m.hub_radius);
  for (std::size_t cam = 0; cam < 2; ++cam) made.profiles[cam] = relieved(made.cut[cam], made.arcs, project.relief.law);
  require_wheel(project.wheel_radius, made.profiles);
  made.contacts = contacts_of(ContactSearch(m, made.lift, made.profiles, project.relief.lead_in), project.steps,
                              gap_in_reach(project));
  made.forces.clear();
  for (const ContactSet& set : made.contacts) made.forces.push_back(forces_at(m, made.lift, project.load, set));
}

void require_wheel(double wheel_radius, std::span<const StepProfile> profiles) {
  const LeastRadii least = least_radii(profiles);
  if (wheel_radius < least.concave) return;
  throw CamError(
      fmt::format("found a grinding wheel of {:.5g} mm; expected less than {:.5g} mm, the concave radius of cam "
                  "{} at {:.5g}°",
                  1e3 * wheel_radius, 1e3 * least.concave, least.concave_cam + 1, least.concave_angle / degree));
}

LeastRadii least_radii(std::span<const StepProfile> profiles) {
  LeastRadii least{infinity, infinity};
  for (const StepProfile& profile : profiles)
    for (const ProfilePoint& point : profile.points) include(least, point.curvature, point.angle, profile.row);
  return least;
}

LeastRadii least_radii(const std::vector<ContactSet>& contacts) {
  LeastRadii least{infinity, infinity};
  for (const ContactSet& set : contacts)
    for (const Contact& contact : set.contacts)
      if (contact.needed) include(least, contact.curvature, sim::angle_of(contact.place), contact.cam);
  return least;
}

}  // namespace stiction::host::step
