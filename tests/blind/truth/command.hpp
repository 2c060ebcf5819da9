// What a drive's own gains leave in the command residual, by a plain linear controller at the
// log's rate, without quantiser, notch and current loop: good below 100 Hz.
#pragma once

#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "tests/blind/truth/axis.hpp"

namespace stiction::blind {

// Current (A) that the true drive commands more than the file's for the x_set and x of a log, zero-phase 1 to 100 Hz;
// the settling at both ends is cut off.
std::vector<double> command_effect(const host::Log& log, const machine::AxisModel& file, const Mechanics& truth);

}  // namespace stiction::blind
