// The outline of a profile as arcs and as cubic curves within a stated distance of it: what files for the shop hold.
#pragma once

#include <vector>

#include "host/cam/step/profile.hpp"

namespace stiction::host::step {

// A corner of a polyline of arcs: `bulge` is the tangent of a quarter of the angle of the arc to the next corner, above
// 0 where it turns to the left (as DXF has it).
struct ArcCorner {
  Point place;  // m
  double bulge = 0.0;
};

// The closed outline of `profile` as arcs, none farther from a point of the profile than `chord`, m.
std::vector<ArcCorner> arcs_of(const StepProfile& profile, double chord);

// A node of a cubic curve over the manufacturing angle.
struct CurveNode {
  double angle = 0.0;  // rad
  Point place;         // m
  Point slope;         // m/rad
};

// The parts of the outline from corner to corner as cubic curves through their nodes, none farther from a point of the
// profile than `chord`, m. Without a corner it is one part that ends where it begins.
std::vector<std::vector<CurveNode>> curves_of(const StepProfile& profile, double chord);

// The curve between the nodes `from` and `to` at an `angle` between theirs, rad.
Point on_curve(const CurveNode& from, const CurveNode& to, double angle);

}  // namespace stiction::host::step
