// The command residual of a record by a plain linear controller at the log's rate, without quantiser, notch and current
// loop: good for differences of two records of one trajectory, below 100 Hz.
#pragma once

#include <vector>

#include "host/log/log.hpp"
#include "sim/model/machine.hpp"

namespace stiction::blind {

// Logged current less what the file's gains give for x_set and x, A, zero-phase 1 to 100 Hz; the settling at both ends
// is cut off.
std::vector<double> command_residual(const host::Log& log, const sim::Axis& file);

}  // namespace stiction::blind
