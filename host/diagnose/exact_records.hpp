// Records of a machine that is exactly as its file says, over the set-points of the training records and under forces
// with the spectrum of what those leave, made ready as those were: what is named in them is the analysis' own doing.
#pragma once

#include <Eigen/Dense>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/judge/command_rows.hpp"
#include "host/diagnose/prepare.hpp"

namespace stiction::host {

// `prepared`: with its training data; `input` of the diagnosis; `original`: those of `prepared` that are drawn again;
// `noise`: like which forces are drawn, and what adds to the record alone, N of their rows. Records without set-points
// are followed anew in each draw, as those were, since the motion that they are followed by contains the answer of the
// loop to the forces; with set-points the regressors are the record's. Where the record's are of its measured motion,
// so are those of the draws.
ExactRecords exact_records(const Prepared& prepared, const DiagnoseInput& input, const Record& original,
                           const ForceOnAxis::Parts& noise);

// Of the draws number begin to end, less one, those that the exact machine can follow: the training records' logs as
// its drive would have recorded them, with windings. `prepared`, `input`: as above; `on_axis`: N, of the training rows,
// like which forces are drawn.
ExactLogs exact_logs(const Prepared& prepared, const DiagnoseInput& input, const Eigen::VectorXd& on_axis);

// What of the residual force of the training records acted on the axis: exact machines move as much under it. All of
// every force where their motion is not known. `prepared`, `input`: as above.
ForceOnAxis force_on_axis(const Prepared& prepared, const DiagnoseInput& input);

}  // namespace stiction::host
