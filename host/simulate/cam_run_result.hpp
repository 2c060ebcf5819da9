// Runs of a cam as a result: following errors of the whole and of each segment, torque, power and energy, with and
// without feedforward and friction compensation.
#pragma once

#include <string>
#include <vector>

#include "host/simulate/cam_run.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct CamRunCase {
  std::string name;   // "feedforward", as it is in the names of figures
  std::string label;  // "with feedforward"
  CamRun run;
  std::string stopped{};  // by which fault, a clause; empty: it ran
};

// "stiction.cam-run/1". `motion` on the axis `axis`, in its own units; `signals`: of the control; `cases`: at least
// one.
sim::ExperimentResult cam_run_result(const sim::cam::Motion& motion, const machine::AxisModel& axis,
                                     const std::string& signals, const std::vector<CamRunCase>& cases);

}  // namespace stiction::host
