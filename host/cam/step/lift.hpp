// The lift of a step cam: the carousel's way over one turn of the cam, from a motion file or from a measured table.
#pragma once

#include <string>
#include <vector>

#include "host/cam/step/angle.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host::step {

// The way and its derivatives over the cam's angle, in rad and rad over rad.
struct LiftState {
  double way = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
};

class StepLift {
 public:
  // `curve`: over one turn from 0 to 2 pi rad, the slave in rad. Throws sim::cam::CamError for a different length.
  explicit StepLift(sim::cam::Curve curve);

  // At the cam's angle `psi` within the turn, rad; behind a joint of the curve.
  LiftState at(double psi) const;
  // What the carousel moves by in a turn, rad.
  double stroke() const { return stroke_; }
  const sim::cam::Curve& curve() const { return curve_; }

 private:
  sim::cam::Curve curve_;
  double start_ = 0.0, stroke_ = 0.0;
};

// The lift of a `cam` of a motion file. Throws sim::cam::CamError where master or slave are not rotary, where the cycle
// is not one turn, and where position or speed jumps.
StepLift lift_of(const sim::cam::Cam& cam);

// A table as it was measured, or came from a different programme: equal columns, in rad and rad over rad.
struct MeasuredLift {
  std::vector<double> psi;
  std::vector<double> way;
  std::vector<double> speed;         // or none
  std::vector<double> acceleration;  // or none
  std::vector<double> splits;        // cam angles where the acceleration jumps
};

// A lift by a spline through the ways of `table`, split at its jumps. Its columns of derivatives are compared with the
// spline's and not used; what differs is said in `notes`, with by how much and where. Throws sim::cam::CamError for
// fewer than 360 rows, for degrees that were taken for radians, and for a table that is not of one turn.
StepLift lift_of(const MeasuredLift& table, std::vector<std::string>& notes);

}  // namespace stiction::host::step
