// What the simulation of an axis gets wrong: causes with parameters and evidence from measured logs, what they gain on
// held-out data, what was rejected and what stays unexplained.
#pragma once

#include "host/diagnose/record/diagnose_input.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// Throws LogError for logs that cannot be used (record_checks.hpp, suitability.hpp).
Verdict diagnose(const DiagnoseInput& input);

}  // namespace stiction::host
