// Relief: the arcs of the profiles that the carousel does not need are lowered, so that a third roller does not touch
// (Dostrasil 2014, chapter 4; docs/step_cams.md). Each arc begins and ends with a blend by a lift law.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/cam/step/contacts.hpp"
#include "sim/cam/law.hpp"

namespace stiction::host::step {

// How an arc is lowered. A valley holds the cam's smallest radius near it, where a roller crosses the line between the
// axes; a peak begins or ends at a corner, where rollers are led in.
struct ReliefShape {
  double depth = 0.0;       // m; 0: no relief
  double blend = 0.0;       // rad, of each end, along the profile
  bool middle_arc = false;  // between the blends a circle about the cam's axis, through the lowest point there
};

// A change of one arc: the one that holds `angle`.
struct ReliefOverride {
  int cam = 0;
  double angle = 0.0;  // rad
  std::optional<double> depth{}, blend{};
  std::optional<double> begin{}, end{};  // rad, of the arc in place of its own ends
};

struct ReliefSettings {
  ReliefShape valley, peak;
  std::string law = "polynomial_3_4_5";  // of the blends: a rise from rest to rest
  double lead_in =
      0.0;  // rad, on both sides of each corner: relieved there too where another roller holds the carousel
  std::vector<ReliefOverride> overrides;
};

struct ReliefArc {
  int cam = 0;
  ProfileArc arc;
  bool valley = false;
  // Whether an end is a corner of the profile: there rollers are led in, and the arc has its whole depth up to it.
  bool begins_at_corner = false, ends_at_corner = false;
  ReliefShape shape;
  std::optional<double> changed_at;  // rad, where the vertex is that changed it
};

// The arcs of the `profiles` that relief lowers: those of both `couplings`, with the shapes of `settings`. `hub`:
// radius of the hub, m. Throws sim::cam::CamError for an override of no arc, for two of one arc, for an arc that
// holds needed contacts, for negative depths and blends, for a law that is no rise from rest, and for a depth that
// reaches the hub.
std::vector<ReliefArc> relief_arcs(const std::array<StepProfile, 2>& profiles, const std::array<Coupling, 2>& couplings,
                                   const ReliefSettings& settings, double hub);

// `profile` lowered on those of `arcs` that are its own, with blends by `law`; radii, corners, normals and curvatures.
StepProfile relieved(const StepProfile& profile, const std::vector<ReliefArc>& arcs, const std::string& law);

}  // namespace stiction::host::step
