// Records of a machine that is exactly as its file says, over the set-points of the training records and under forces
// with the spectrum of what those leave, made ready as those were: what is named in them is the analysis' own doing.
#pragma once

#include <Eigen/Dense>
#include <functional>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/prepare.hpp"

namespace stiction::host {

// Of the record `training`, with set-points; `disturbed`: the machine of the file under the forces. The regressors are
// the record's.
ExactRecords exact_records(const Record& training, EffectResponse disturbed);
// Of records without set-points: each draw is followed anew, as those were, since the motion that it is followed by
// contains the answer of the loop to the forces. `prepared`: with its training data; `input` of the diagnosis; `force`:
// N, of the rows.
ExactRecords exact_records_to_follow(const Prepared& prepared, const DiagnoseInput& input,
                                     const Eigen::VectorXd& force);

}  // namespace stiction::host
