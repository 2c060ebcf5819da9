// A log's channels in the units of its axis, and as the linear axis has them that all computations work on.
#pragma once

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Throws LogError where `channels` of a `log` are linear and the axis of the machine is rotary, or the other way about.
void require_same_kind(const Log& log, const AxisLog& channels, const machine::AxisModel& axis);

// The channels of a rotary axis as those of the linear axis of `coordinate` that moves alike, and back. A linear axis
// stays as it is.
AxisLog as_linear(AxisLog axis, const machine::Coordinate& coordinate);
AxisLog in_own_units(AxisLog axis, const machine::Coordinate& coordinate);

// How a value of a channel is shown: times `factor`, in `unit`.
struct ShownUnit {
  double factor;
  const char* unit;
};
ShownUnit shown_deviation(bool rotary);  // of a position: um, urad
ShownUnit shown_position(bool rotary);   // mm, deg
ShownUnit shown_speed(bool rotary);      // m/min, deg/s
const char* force_unit(bool rotary);     // N, N m

}  // namespace stiction::host
