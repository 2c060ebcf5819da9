// The actual profile of one cam: what all rollers of its row leave of it in a turn. At equal steps of the manufacturing
// angle it is the smallest radius of all paths of contacts; where the roller that leaves it changes there is a vertex.
#pragma once

#include <vector>

#include "host/cam/step/roller_path.hpp"

namespace stiction::host::step {

struct ProfilePoint {
  double angle = 0.0;      // manufacturing angle in the cam's frame, rad
  double radius = 0.0;     // m, from the cam's axis
  int roller = 0;          // of the row, that touches here
  double psi = 0.0;        // the cam's angle at which it does, rad
  Point normal{};          // of length 1, into the cam
  double curvature = 0.0;  // of the actual profile, 1/m; above 0: convex

  Point place() const { return sim::in_direction(radius, angle); }
};

// A corner, where one roller's part of the profile ends and the next one's begins.
struct ProfileVertex {
  double angle = 0.0, radius = 0.0;
  std::size_t behind = 0;  // the first point behind it
  bool peak = false;       // it points outwards

  Point place() const { return sim::in_direction(radius, angle); }
};

struct StepProfile {
  int row = 0;
  std::vector<ProfilePoint> points;     // at equal steps of the angle, from 0
  std::vector<ProfileVertex> vertices;  // in the order of the angle
  double least_radius = 0.0, largest_radius = 0.0;

  double step() const;  // of the angle, rad
  // The radius at any `angle`, rad, between its points; on each side of a vertex that side's.
  double radius_at(double angle) const;
  // Whether a corner is within `distance` of the `angle`, rad.
  bool has_corner(double angle, double distance) const;
};

// The lift at equal steps of the cam's angle, from 0 to the whole turn.
struct SampledLift {
  const StepLift* lift = nullptr;
  std::vector<double> psi;
  std::vector<LiftState> states;
};
// `steps`: in a turn, at least 360.
SampledLift sampled(const StepLift& lift, int steps);

// The profile of the cam of that `row`, 0 or 1, of `mechanism` with that `lift` at `points` equal steps, at least 360.
// Throws sim::cam::CamError for an angle that no roller reaches. Linear in points times rollers.
StepProfile cut_profile(const StepMechanism& mechanism, const SampledLift& lift, int row, int points);

}  // namespace stiction::host::step
