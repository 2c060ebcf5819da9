// Rollers that are led in at the corners of a profile: what a late one is pressed by there, with and without relief.
#pragma once

#include <array>
#include <vector>

#include "host/cam/step/contacts.hpp"

namespace stiction::host::step {

// A corner driven over in one direction.
struct LeadIn {
  int cam = 0;
  double angle = 0.0;     // of the corner, rad
  bool forwards = true;   // the cam turns as its angle grows
  double cut = 0.0;       // m, that the roller is pressed into the profile before relief within the first degree
  double relieved = 0.0;  // and after it; the force is this times the stiffness of the contact
};

// Every corner of the `cut` profiles of `mechanism` with that `lift` in both directions, with a roller that is late by
// `late`, m, along its circle. `relieved`: the profiles after relief.
std::vector<LeadIn> lead_ins(const StepMechanism& mechanism, const StepLift& lift,
                             const std::array<StepProfile, 2>& cut, const std::array<StepProfile, 2>& relieved,
                             double late);

}  // namespace stiction::host::step
