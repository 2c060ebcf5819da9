// The judgements of an inspection: what is suspicious in a log, and what it can determine. Private to inspection.cpp.
#pragma once

#include "host/log/inspection.hpp"

namespace stiction::host {

void add_suspicions(const Log& log, const AxisLog& axis, const KnownAxis& known, AxisInspection& out);
void add_determinable(const Log& log, const AxisLog& axis, const KnownAxis& known, const FittedMotion& motion,
                      AxisInspection& out);

}  // namespace stiction::host
