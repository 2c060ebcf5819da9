// Whether the second cam is the mirrored first one, and about which axes: where the zero pin may go (Dostrasil 2014,
// chapter 4: the pin and the cam's axis define the line about which one cam is mirrored onto the other; the points of
// symmetry are sought on the profiles and come in pairs half a turn apart, as a rule one pair, sometimes more).
#pragma once

#include <array>
#include <vector>

#include "host/cam/step/profile.hpp"

namespace stiction::host::step {

struct Symmetry {
  double axis = 0.0;         // rad, in the cam's frame, 0 up to half a turn: the one that is nearest to a mirror
  double distance = 0.0;     // m, largest difference of radii from the mirrored cam about it
  std::vector<double> axes;  // rad, all about which the cams are mirrored, rising; each meets the profile twice

  // Whether one drawing makes both cams.
  bool holds() const { return !axes.empty(); }
};

// Differences of radii up to this are none, m.
inline constexpr double mirrored_within = 1e-9;

// The axes about which the second of `profiles` is the mirrored first one, and the one about which it comes nearest to
// it. Corners are compared within three steps as the radii between them are, not across. About 360 coarse comparisons
// of 120 points, and a search by halves for each axis that may hold.
Symmetry symmetry_of(const std::array<StepProfile, 2>& profiles);

}  // namespace stiction::host::step
