// Which axes of a machine a request is for, from its logs where it names none.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// By index: the axis `name` of `machine`, else each that every log of `logs` has channels of. Throws UsageError.
std::vector<std::size_t> axes_to_diagnose(const std::string& name, const machine::Machine& machine,
                                          const std::vector<Log>& logs);

// By index: the axis `name` of `machine`, else all that every log of `logs` has channels of; without logs all. Throws
// UsageError.
std::vector<std::size_t> axes_to_tune(const std::string& name, const machine::Machine& machine,
                                      const std::vector<Log>& logs);

}  // namespace stiction::host
