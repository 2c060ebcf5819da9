// The frequency responses of axes as an experiment's result: a Bode plot a loop and axis with its margins, and figures.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/response/axis_response.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

struct ResponseText {
  std::string signals;    // of the control: "fixed"; "measured" of a log
  std::string condition;  // one sentence: what was excited, and how
  bool simulated = true;  // the gains at which the simulated axis goes unstable are known
};

// `loops`: which of "current", "velocity", "position" are shown; empty: all, and the plant. `responses`: of the axes;
// `machine`: for expected figures; `text`: title and condition of the measurement.
sim::ExperimentResult response_result(const std::vector<AxisResponse>& responses, const machine::Machine& machine,
                                      const std::vector<std::string>& loops, const ResponseText& text);

}  // namespace stiction::host
