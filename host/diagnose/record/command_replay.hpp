// What a drive would have commanded on the way that a record shows: the drive's own control (firmware/include), driven
// by the recorded set-points and the recorded position, its current loop closed over the windings alone, which move as
// the record says. Nothing of the carriage is in it: what the record differs by is the drive's doing.
#pragma once

#include <optional>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The recorded output of the controller that is compared.
struct RecordedCommand {
  std::vector<double> AxisLog::*values;
  const char* unit;  // "A" or "V"
  const char* name;  // of the channel
};

// The voltage of a force source, else the current, else the set current; none when the record has none of them, or no
// set-points, or a test signal in another place of the loop.
std::optional<RecordedCommand> recorded_command(const AxisLog& channels, const machine::AxisModel& axis);

// The same at the record's times (A or V), from `axis` with its own effects; it begins at rest, with an integrator that
// does not know the record's. Between the samples positions are those of a spline. S: FixedSignals, the drive's own
// numbers, or sim::DoubleSignals. Throws sim::ConfigurationError; LogError where the control stops on these inputs.
template <class S>
// `timing` of the loops; `log` with its `channels` of this axis.
std::vector<double> replay_command(const machine::Timing& timing, const machine::AxisModel& axis, const Log& log,
                                   const AxisLog& channels);

}  // namespace stiction::host
