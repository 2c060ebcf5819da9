// The set-points of a log through the control loop over the simulated machine.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "host/simulate/control_run.hpp"

namespace stiction::host {

struct ReplaySettings {
  std::string axis;  // of the machine, for a log whose channels name none; empty: the machine's only axis
};

// What the simulated machine does with the set-points of `log`: a log with the same time and axes, whose channels are
// x_set, v_set, a_set (as they were followed), x, v, i (A, what makes the force; u in V for a force motor), i_set and
// force (N). `trace` sees every tick, beginning with those before the log.
//
// Where the log begins in motion, the machine is brought there: backwards with the log's first acceleration to rest if
// that takes at most `longest_lead_in`, else by a smooth ramp of that length. It then begins at rest, and no sooner in
// time than needed; position controller and log start on the same tick. Behind a master that turns steadily the log's
// first cycle is gone through before it, as often as it takes a swing of the load to settle (repeating_motion.hpp).
// Axes that the log does not have stand still at 0. An external force in the log acts on the carriage, and a test
// signal (i_inject; u_inject of a force motor) where the drive adds it; one for which the simulation has no input does
// not act (injection.hpp says which). Where a measured position is off its set-point by more than the following error
// that the machine allows, the encoder has another zero: its mean distance is added to the simulated position, so that
// both can be compared (see encoder_offset).
//
// Of an endless axis the log has the phase too, counted from the encoder's increments (endless_counter.hpp), at the
// last tick before the time of the sample. The channels of a rotary axis are in its own units, in both logs. Between
// ticks the simulated values are interpolated linearly. Where the machine's record has the current late (effect
// time_skew), so are i, u, i_set and force. S: FixedSignals or sim::DoubleSignals. Throws LogError when log and machine
// do not fit (axes, no x_set, beyond the machine's velocity), FaultTripped, sim::ConfigurationError. `settings`: the
// axis of a log without axis names.
template <class S>
Log replay(const machine::Machine& machine, const Log& log, const ReplaySettings& settings = {},
           const TraceSink<S>& trace = {});

// The same of a log whose channels are those of the linear axes on which all computing is done (own_units.hpp), and so
// are those of the result. S, `machine`, `settings`, `trace` and errors: as above.
template <class S>
Log replay_linear(const machine::Machine& machine, const Log& log, const ReplaySettings& settings = {},
                  const TraceSink<S>& trace = {});

// The same `log`, with the same `settings`, in the firmware's numbers, or in double precision where these hold an axis
// of the `machine` on no radius.
Log replay_linear_as_held(const machine::Machine& machine, const Log& log, const ReplaySettings& settings = {});

// The machine's axis for each of the log's, by index. Throws LogError.
std::vector<std::size_t> match_axes(const machine::Machine& machine, const Log& log, const std::string& axis);

// Mean of x - x_set where it is beyond `allowed`, in the unit of both, else 0.
double encoder_offset(const AxisLog& axis, double allowed);

}  // namespace stiction::host
