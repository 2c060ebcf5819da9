// The friction model that is to meet the measured machine (docs/friction_model.md): its parameters from the machine
// file's rows of steady friction, of presliding and of the circle at one feed; the circles at all other feeds are
// predicted.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/friction_curves.hpp"
#include "sim/plant/friction/maxwell_slip.hpp"

namespace stiction::host {

inline constexpr double calibration_feed = 16.0 / 60.0;  // m/s

// What may enter the parameters; nothing else of the machine's rows does.
struct PermittedRows {
  std::vector<SteadyPoint> steady;
  std::vector<PreslidingPoint> presliding;
  std::vector<machine::CircleReference> circle;  // measured at the calibration feed, one an axis in the machine's order
};

// Throws MissingRows when the machine has no such rows.
PermittedRows permitted_rows(const machine::Machine& machine);

// One axis after calibration.
struct CalibratedAxis {
  std::string axis;
  double force = 1.0;                   // scale of all friction
  double displacement = 1.0;            // scale of all displacements
  double error = 0.0;                   // m, simulated at the calibration feed
  double current = 0.0;                 // A
  sim::MaxwellSlipParameters friction;  // what comes of it
};

struct MeasuredMachine {
  SteadyCurve sliding;
  PreslidingCurve presliding;
  std::vector<CalibratedAxis> axes;
};

// Two numbers an axis, peak error and peak current at the calibration feed, determine its two scales, by circles in
// double precision. Throws MissingRows, FaultTripped.
MeasuredMachine identify_measured_machine(const machine::Machine& machine);

// The machine with the identified friction in use on every axis.
machine::Machine with_friction(machine::Machine machine, const MeasuredMachine& identified);

// One measured row beside the simulation. SI units.
struct PredictedRow {
  std::string axis;
  double feed = 0.0;
  bool held_out = true;  // false: a row of the calibration
  double error = 0.0, measured_error = 0.0;
  double current = 0.0, measured_current = 0.0;
};

// Every measured circle of the machine, simulated with the identified friction, in the order of the file.
std::vector<PredictedRow> predict_circles(const machine::Machine& machine, const MeasuredMachine& identified);

// Mean |simulated / measured - 1| over the held-out rows of an axis.
struct HeldOutScore {
  std::string axis;
  double error = 0.0;
  double current = 0.0;
};
std::vector<HeldOutScore> held_out_scores(const std::vector<PredictedRow>& rows);

// Mean of all axes' quantities.
double mean_of(const std::vector<HeldOutScore>& scores);

}  // namespace stiction::host
