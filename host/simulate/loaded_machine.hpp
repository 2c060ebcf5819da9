// A machine as a command runs on it: read with its overrides, checked down to the drive's number formats and to what
// the command needs.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::host {

// The machine `name` (shipped, or a path) as it is in `experiment`, with the assignments `set` ("KEY=VALUE"), checked
// to the drive's number formats where those matter and to what a command `needs`; where it runs on one axis, with the
// axis `axis` alone, or the first where that is empty. Throws machine::MachineFileError.
machine::Machine load_machine(const std::string& name, const std::vector<std::string>& set,
                              const std::string& experiment, const MachineNeeds& needs, const std::string& axis = {});

// The assignment that chooses the friction compensation `kind` for every axis.
inline std::string compensation_assignment(const std::string& kind) {
  return "axis.*.friction_compensation.use=" + kind;
}

}  // namespace stiction::host
