// Keys of findings that would make the simulation follow held-out set-points worse than the file does. A description
// can be right by its name and its force, and too stiff, too soft or too wide for the loop: the name then stays, and
// its keys are not written.
#pragma once

#include <vector>

#include "host/diagnose/judge/position_error.hpp"

namespace stiction::host {

// Gives those of `findings` a reason why their keys are withheld (Finding::withheld) with which the machine's error
// against the `measured` positions of the setup's logs is larger than the file's, beyond the scatter of ten runs of
// each under draws of the `disturbance`. Of several findings the one whose keys do most of it comes first. Where the
// file's own error is within twice its scatter nothing is said. `setup`: of the machine file.
void withhold_what_follows_worse(std::vector<Finding>& findings, const ReplaySetup& setup, const Positions& measured,
                                 const Disturbance& disturbance);

}  // namespace stiction::host
