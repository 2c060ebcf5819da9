// The coordinates of an axis and its motor, from its kind and transmission: what the units of its table mean.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "firmware/machine/file/table_reader.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Those of the axis in `table` at `path` of `document`, where a radian of a rotary axis is `radius` (m) long. Throws
// MachineFileError for a transmission that the kind of the axis does not have.
AxisCoordinates coordinates_of(const Document& document, const toml::table& table, const std::string& path,
                               double radius);

// Whether the force constant of the motor in the table of an `axis` is one per ampere.
bool driven_by_amperes(const toml::table& axis);

// Adds to an `axis` that was read with `coordinates` what follows from them: the mass of its transmission and its
// counterweight, the damping of its shaft, the friction of its motor, the increments that its encoders' counts make,
// the limits of a force source, and the following error of a rotary axis that has no limit of its own. `table` at
// `path` of `document`: the axis'. Throws MachineFileError for counts of an encoder on what does not turn.
void reduce(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis,
            const AxisCoordinates& coordinates);

}  // namespace stiction::machine
