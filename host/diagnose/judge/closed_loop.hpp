// What the user sees of the causes: the held-out logs' set-points through the simulated machine without and with them,
// position error against the measured one.
#pragma once

#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/diagnose/record/disturbance.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// Fills in position errors, their ratios by finding, what each does to the position, and which keys are withheld.
// Without set-points nothing is changed. A machine that cannot follow the set-points is a LogError without causes; with
// them it is a note, and the keys are withheld that keep it from following. `verdict`:
// with its findings on `axis`, the index in `machine`; `held_out`: logs that were not used; `disturbance`: what acts on
// the axis beside. Returns what that makes of the position, m rms.
double judge_in_closed_loop(Verdict& verdict, const machine::Machine& machine, std::size_t axis,
                            const std::vector<Log>& held_out, const Disturbance& disturbance = {});

}  // namespace stiction::host
