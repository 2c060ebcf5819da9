// From the machine file's friction compensation to the drive's configuration.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "firmware/machine/configuration/axis_configuration.hpp"
#include "stiction/drive/friction_compensation.hpp"

namespace stiction::machine {

// Whether an axis has friction compensation that acts; all axes then have its stage, so that a path stays together.
bool has_compensation(const Machine& machine);

// s, by which the axes follow their set-points late: none where no compensation acts.
double set_point_delay(const Machine& machine);

// S: FixedSignals or DoubleSignals. Throws ConfigurationError.
template <class S>
FrictionCompensationConfig<S> configure_compensation(const Machine& machine, const AxisModel& axis);

// Of all axes; empty where has_compensation() is false.
template <class S>
std::vector<FrictionCompensationConfig<S>> configure_compensations(const Machine& machine);

// What tells a learned table of this axis from others: a hash of both names, not 0.
std::uint32_t learning_identity(std::string_view machine, std::string_view axis);

// The time (s) from a force to the error it makes, to which learning credits the error.
double learning_lead(const AxisModel& axis);

// The speeds (m/s) of the nodes of the drive's sliding table.
std::vector<double> sliding_node_speeds();

// A (speed, value) list, increasing in speed, read at `speed`: from zero at rest by straight lines, beyond its end by
// the last one's slope. `speeds` in m/s; `values` in the unit of the result, one for each.
double sliding_value(const std::vector<double>& speeds, const std::vector<double>& values, double speed);

}  // namespace stiction::machine
