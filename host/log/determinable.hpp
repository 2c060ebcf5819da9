// The judgements of an inspection: what is suspicious in a log, and what it can determine. Private to inspection.cpp.
#pragma once

#include "host/log/inspection.hpp"

namespace stiction::host {

// Sentences on signals that look wrong. `log`: with its time; `axis`: its channels; `known`: what the machine file says
// of the axis; `out`: fit, plateaus and saturation, to which they are added.
void add_suspicions(const Log& log, const AxisLog& axis, const KnownAxis& known, AxisInspection& out);
// The quantities that the log can determine. `log`, `axis`, `known`, `out`: as above; `motion`: smoothed speed and
// acceleration of the axis.
void add_determinable(const Log& log, const AxisLog& axis, const KnownAxis& known, const FittedMotion& motion,
                      AxisInspection& out);

}  // namespace stiction::host
