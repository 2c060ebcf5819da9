// The tables [[reference.*]] of a machine file: published or measured rows.
#pragma once

#include <string_view>
#include <vector>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Adds the rows of `document` to `machine`, whose axes are read already. `models`: names of the friction models. Throws
// MachineFileError.
void read_references(const Document& document, const std::vector<std::string_view>& models, Machine& machine);

}  // namespace stiction::machine
