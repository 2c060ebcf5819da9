// Whether a step cam can be built, with the place, the numbers and what would help where it cannot.
#pragma once

#include <span>
#include <vector>

#include "host/cam/step/contacts.hpp"

namespace stiction::host::step {

// How the carousel's steps and rollers fit: after so many turns of the cam the carousel is where it was, and each row
// leaves so many different paths on its cam.
struct StepCount {
  int turns = 0, paths = 0;
};

// The dimensions alone, and the stroke of `lift` against the pitch of the rollers. Throws sim::cam::CamError.
StepCount count_steps(const StepMechanism& mechanism, const StepLift& lift);

// Whether paths of `mechanism` with that `lift` turn back or are undercut where one of its `profiles` needs them.
// Throws sim::cam::CamError.
void require_buildable(const StepMechanism& mechanism, const SampledLift& lift, std::span<const StepProfile> profiles);

// Whether both cams of `mechanism` touch at every angle and hold the carousel both ways, of its `contacts` over a turn.
// Throws sim::cam::CamError.
void require_held(const StepMechanism& mechanism, const std::vector<ContactSet>& contacts);

}  // namespace stiction::host::step
