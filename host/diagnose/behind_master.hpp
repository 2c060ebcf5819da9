// A slave that follows its master late: what its simulation must do as well before anything else is looked for in the
// force. Its set-points are then those of another time, and all that the file's own run leaves is as well.
#pragma once

#include <optional>

#include "host/diagnose/prepare.hpp"
#include "host/diagnose/record/diagnose_input.hpp"

namespace stiction::host {

// The `input` with the delay in its machine that the command of the records tells, which are `prepared` of it; none
// where it tells none.
std::optional<DiagnoseInput> behind_master(const DiagnoseInput& input, const Prepared& prepared);

}  // namespace stiction::host
