// The irregular path (Mendricky 2006, 6.4) on one machine: what is left at standstill and the two restarts of Y.
#pragma once

#include <optional>

#include "firmware/machine/model/machine.hpp"
#include "host/simulate/control_run.hpp"
#include "sim/experiment/experiment_result.hpp"
#include "stiction/number/fixed_signals.hpp"

namespace stiction::host {

struct LShapeRun {
  double standing_current = 0.0;  // A of Y standing from F to G, positive in +y; its motion before was in -y
  double same_error = 0.0;        // m, peak of Y, restart in the direction of the motion before (8 m/min)
  double opposite_error = 0.0;    // m, restart in the opposite direction
  sim::Series error, current;     // of Y: um and A over s

  // The current against the motion before: what the contact keeps of its friction.
  double kept_current() const { return -standing_current; }
};

// Throws InfeasibleMotion for a machine without two axes, or with one that cannot drive the path, and for a `jerk`
// (m/s^3) lower than that of the arcs.
void check_l_shape(const machine::Machine& machine, std::optional<double> jerk = {});

// With the friction models that the machine's axes use, firmware in fixed point. The first axis of the machine is X,
// the second Y. `trace` is given every tick. `jerk` (m/s^3): the limit of the jerk of the set-points; none: the
// acceleration steps where arcs begin and end, and at the start. Throws InfeasibleMotion, FaultTripped.
LShapeRun drive_l_shape(const machine::Machine& machine, const TraceSink<FixedSignals>& trace = {},
                        std::optional<double> jerk = {});

}  // namespace stiction::host
