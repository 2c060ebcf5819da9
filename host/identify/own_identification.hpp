// The border of an identification for rotary axes: logs come in as those of the linear axis on which all computing is
// done, results go out in the axis' own units and under the names that go with them.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The logs with the channels of a rotary `axis` in the units of the linear one; as they are for a linear axis. Throws
// LogError for channels of the other kind.
std::vector<Log> linear_logs(std::vector<Log> logs, const machine::AxisModel& axis);
// The same of every axis of a machine. `logs`, errors: as above; `axes`: of the machine.
std::vector<Log> linear_logs(std::vector<Log> logs, const std::vector<machine::AxisModel>& axes);

// "coulomb_N" of a rotary axis: "coulomb_N_m"; "mass_kg": "inertia_kg_m2". Other names stay.
std::string own_name(const std::string& name);

// Every quantity in the units of `axis`; as it is for a linear axis.
Identification in_own_units(Identification result, const machine::AxisModel& axis);

}  // namespace stiction::host
