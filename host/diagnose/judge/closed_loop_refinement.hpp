// The findings' parameters in closed loop (output error: Ljung 1999, ch. 7): the records' set-points run through the
// simulated machine with all findings in it, and Gauss-Newton steps move the parameters until the residual force of
// that run fits the recorded one best. Unlike the regressors of the search, a run knows how the drive answers, and how
// the findings act on one another.
#pragma once

#include <span>
#include <vector>

#include "host/diagnose/record/replay_setup.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// `findings`: with start values and standard errors of their parameters; both are replaced where the fit gets better.
// `found`: their terms in the same order; `rows`, `target`: what they were found on; `responses`: of these records,
// with different hunting, of which the one that fits best counts. A term whose phase differs from record to record, and
// one that replays under disturbances, stays as it is. `context`: of the search.
void refine_in_closed_loop(std::vector<Finding>& findings, const SearchResult& found,
                           std::span<EffectResponse> responses, const LogRows& rows, const Eigen::VectorXd& target,
                           const SearchContext& context);

}  // namespace stiction::host
