// What is identified, from the texts of a request.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The axis `name` of `machine`, or the only one that it and `logs` have in common. Throws UsageError.
const machine::AxisModel& axis_to_identify(const std::string& name, const machine::Machine& machine,
                                           const std::vector<Log>& logs);

// The convention of currents that `text` names; empty: by the format of a log. Throws UsageError.
Amperes amperes_of(const std::string& text);

// The law to identify on `axis`: `wanted`, or the usual one where that is empty. Throws UsageError.
std::string model_to_identify(const std::string& wanted, const machine::AxisModel& axis);

// The values of `fixes`, "mass=225kg", in the order of the fit's columns, of a linear axis in place of `axis`. Throws
// UsageError.
Held held_values(const std::vector<std::string>& fixes, const machine::AxisModel& axis);

}  // namespace stiction::host
