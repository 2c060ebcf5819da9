// What the values of [axis.NAME.friction_compensation] must say together: tables that rise where they must, amplitudes
// that the drive can give, a look-ahead that the buffer of set-points holds.
#pragma once

#include <string>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// `table`: that of the axis, at `path`; `machine`: its name and timing are read already. Throws MachineFileError.
// `document`: names the place in messages.
void check_compensation(const Document& document, const toml::table& table, const std::string& path,
                        const AxisModel& axis, const Machine& machine);

}  // namespace stiction::machine
