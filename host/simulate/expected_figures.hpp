// The figures that the machine file expects of an experiment, put to the figures of a run.
#pragma once

#include <map>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// "peak_deviation" of "peak_deviation_lugre": as a machine file names a figure.
std::string name_without_model(const sim::Figure& figure);

// Puts the rows [[expected]] of the machine that are in force to the figures of the result. `options`: of the
// experiment, as this run had them, in SI ("jerk", 40.0). A row without a figure becomes a finding where the run was
// `complete`, as its name may be a typo; rows for other overrides are named. Throws MachineFileError for a value whose
// unit is not the figure's.
void add_expected_figures(sim::ExperimentResult& result, const machine::Machine& machine,
                          const std::map<std::string, double>& options = {}, bool complete = true);

}  // namespace stiction::host
