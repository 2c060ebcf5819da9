// Refinement in closed loop: the machine's own controller with the log's set-points drives the simulated axis, and
// mass, friction and contact stiffness are moved until the force agrees with the logged one (output error: Ljung
// 1999, 10.1). The measured position takes no part in it, so its noise cannot bend the parameters as it bends
// regressors.
#pragma once

#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"

namespace stiction::host {

struct Refinement {
  std::vector<IdentifiedParameter> parameters;         // those that were moved
  double force_before = 0.0, force_after = 0.0;        // N rms, simulated minus logged in the band of the rows
  double position_before = 0.0, position_after = 0.0;  // m rms
  int simulations = 0;                                 // of all logs
};

// Starts from `result` (of the same logs): mass, Coulomb and viscous friction, and the contact's stiffness where it is
// determined (LuGre); without it the friction is the classical model, which sticks. The logs should begin at rest and
// hold set-points; the first quarter of a second does not count. Throws LogError for a log without set-points, or when
// a parameter to start from is missing, or when no simulation runs through. `machine`: controllers and limits; `axis`:
// of it; `options`: amperes and bootstrap.
Refinement refine_in_closed_loop(const std::vector<Log>& logs, const machine::Machine& machine,
                                 const machine::AxisModel& axis, const Identification& result,
                                 const IdentifyOptions& options);

}  // namespace stiction::host
