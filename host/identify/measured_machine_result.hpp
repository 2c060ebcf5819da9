// The identification from reference rows as figures, findings and charts: parameters, calibration, the held-out table,
// the path "L".
#pragma once

#include <string>

#include "host/identify/measured_machine.hpp"
#include "host/simulate/l_shape.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// What was identified and what it predicts.
struct MeasuredMachineStudy {
  MeasuredMachine identified;
  std::vector<PredictedRow> rows;
  LShapeRun l_shape;

  double creeping_current_of_y = 0.0;  // A, Coulomb friction of the elements over the force constant
  double kept_share() const { return l_shape.kept_current() / creeping_current_of_y; }
  double restart_share() const { return l_shape.same_error / l_shape.opposite_error; }
};

// `circle`, `l_shape`: the machine as it is in these experiments. Throws MissingRows, FaultTripped.
MeasuredMachineStudy study_measured_machine(const machine::Machine& circle, const machine::Machine& l_shape);

sim::ExperimentResult measured_machine_result(const machine::Machine& machine, const MeasuredMachineStudy& study);

// The rows as a table for a terminal.
std::string prediction_text(const machine::Machine& machine, const MeasuredMachineStudy& study);

// [axis.NAME.friction.maxwell_slip] of every axis, for a machine file.
std::string friction_toml(const MeasuredMachine& identified);

}  // namespace stiction::host
