// Verdicts as an engine might leave them, for tests of their report: shapes that look like an axis', and no engine.
#pragma once

#include "host/report/diagnosis_report.hpp"

namespace stiction::host {

// Two causes with charts, rejected ones, something unexplained, notes.
DiagnosisReport synthetic_diagnosis();
// The same of an axis behind a cam, to which a cam is proposed.
DiagnosisReport synthetic_cam_proposal();
// Nothing found, nothing rejected, no held-out log, no set-points.
DiagnosisReport synthetic_agreement();

}  // namespace stiction::host
