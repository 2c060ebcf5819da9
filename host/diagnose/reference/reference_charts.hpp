// The pictures of a diagnosis from measured rows: over the feed, measured against simulated before and after; of each
// cause the curve that it changes and what it does to each row.
#pragma once

#include "host/diagnose/reference/reference_extension.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// `verdict`: to which they are added; `machine` of the file; `extension`: what was fitted to its rows.
void add_reference_charts(Verdict& verdict, const machine::Machine& machine, const ReferenceExtension& extension);

}  // namespace stiction::host
