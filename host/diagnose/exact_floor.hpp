// What exact machines leave of records like those of a diagnosis: where the motion is measured, or followed, that is
// more than of a run in silence, since the axis answers to forces otherwise than the motion shows that is known of it.
#pragma once

#include "host/diagnose/prepare.hpp"
#include "host/diagnose/record/diagnose_input.hpp"

namespace stiction::host {

// Takes it off the targets of `prepared`, whose context has exact_records(), where the residual is likelier so: its
// mean over draws under forces like the residual. `input` of the diagnosis.
void take_exact_floor_off(Prepared& prepared, const DiagnoseInput& input);

}  // namespace stiction::host
