// A whole step cam from its project: both profiles, contacts, relief, forces; what every output shows.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "host/cam/step/feasibility.hpp"
#include "host/cam/step/forces.hpp"
#include "host/cam/step/project.hpp"
#include "host/cam/step/symmetry.hpp"

namespace stiction::host::step {

// Shares of the turn with so many contacts.
struct ContactShares {
  double two = 0.0, three = 0.0, other = 0.0;
};

struct StepSynthesis {
  StepLift lift;
  StepCount count;
  std::array<StepProfile, 2> cut;       // before relief
  std::array<StepProfile, 2> profiles;  // what is ground
  std::array<Coupling, 2> couplings;    // of the cut profiles
  std::vector<ReliefArc> arcs;
  Symmetry symmetry;
  std::vector<ContactSet> unrelieved, contacts;  // over a turn, in equal steps
  std::vector<StepForces> forces;
  std::vector<std::string> notes;

  ContactShares shares(const std::vector<ContactSet>& sets) const;
};

// The lift of `project`; what is odd about a table is added to `notes`. Throws sim::cam::CamError.
StepLift lift_of(const StepProject& project, std::vector<std::string>& notes);

// All of it. Throws sim::cam::CamError for what cannot be built, with the place and what would help.
StepSynthesis synthesize(const StepProject& project);

// The same with a different `relief`: profiles, contacts and forces of `made` are replaced, what does not depend on the
// relief is kept. Throws sim::cam::CamError.
void relieve_again(StepSynthesis& made, const StepProject& project);

// The smallest radii of the profiles in m and the manufacturing angles in rad where they are; infinite where a profile
// has no convex or no concave part.
struct LeastRadii {
  double convex = 0.0, concave = 0.0;
  double convex_angle = 0.0, concave_angle = 0.0;
  int convex_cam = 0, concave_cam = 0;
};
LeastRadii least_radii(std::span<const StepProfile> profiles);
// The same of the places that the carousel needs, before relief.
LeastRadii least_radii(const std::vector<ContactSet>& contacts);

// Whether a wheel of `wheel_radius`, m, is smaller than the hollows of `profiles`. Throws sim::cam::CamError with the
// place.
void require_wheel(double wheel_radius, std::span<const StepProfile> profiles);

}  // namespace stiction::host::step
