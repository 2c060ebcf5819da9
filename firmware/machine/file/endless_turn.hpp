// The turn of an endless axis in counts of its encoder, as an exact fraction from the numbers of the file.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Gives an endless `axis`, whose values were read from `table` at `path` of `document`, its exact modulo and the counts
// of its encoder in one, where these are a fraction; gives every axis the exact ratio of its transmission. Throws
// MachineFileError for a modulo, a ratio or counts of which the fraction is not known or too long, and for a modulo
// that is no whole number of increments of an encoder on the load.
void keep_exactly(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis);

}  // namespace stiction::machine
