// Whether the second cam is the mirrored first one, and about which axis: where the zero pin goes.
#pragma once

#include <array>

#include "host/cam/step/profile.hpp"

namespace stiction::host::step {

struct Symmetry {
  double axis = 0.0;      // rad, in the cam's frame, 0 up to half a turn
  double distance = 0.0;  // m, largest difference of radii from the mirrored cam

  // Whether one drawing makes both cams.
  bool holds() const { return distance <= 1e-9; }
};

// The axis about which the second of `profiles` is nearest to the mirrored first one. Corners are compared within three
// steps as the radii between them are, not across.
Symmetry symmetry_of(const std::array<StepProfile, 2>& profiles);

}  // namespace stiction::host::step
