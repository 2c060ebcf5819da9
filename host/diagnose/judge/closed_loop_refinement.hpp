// The findings' parameters in closed loop (output error: Ljung 1999, ch. 7): the records' set-points run through the
// simulated machine with all findings in it, and Gauss-Newton steps move the parameters until the residual force of
// that run fits the recorded one best. Unlike the regressors of the search, a run knows how the drive answers, and how
// the findings act on one another.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/diagnose/record/effect_response.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

struct ClosedLoopRefinement {
  std::vector<Finding> findings;  // with the parameters and standard errors of the better fit
  Eigen::VectorXd left;           // N, of the rows, not whitened: what the findings leave
  // Index of the response whose runs fit best; none where the terms as they are fit better.
  std::optional<std::size_t> response{};
};

// Not one whose phase differs from record to record, or whose clock goes on through them, nor one that replays under
// disturbances.
bool described_by_runs(const Term& term);

// `findings`: with start values and standard errors of their parameters; `terms`: theirs, in the same order;
// `rows`, `target`: what they were found on, less what has no name; `left`: what the terms leave of it; `responses`: of
// these records, with different hunting, of which the one that fits best counts. A term that no run describes
// (described_by_runs()) stays as it is. `context`: of the search.
ClosedLoopRefinement refine_in_closed_loop(std::vector<Finding> findings, std::span<const Term> terms,
                                           std::span<EffectResponse> responses, const LogRows& rows,
                                           const Eigen::VectorXd& target, Eigen::VectorXd left,
                                           const SearchContext& context);

}  // namespace stiction::host
