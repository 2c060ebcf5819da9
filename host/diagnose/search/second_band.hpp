// The findings once more in a narrower band: what is as large there as in the whole one is what it is said to be; what
// is not hides something that depends on frequency, such as a delay that is wrong.
#pragma once

#include <Eigen/Dense>
#include <span>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Adds to each finding's evidence how large its force is in the rows below 30 Hz, over that in the whole band, and to
// the verdict's notes where the two contradict each other. `terms`: of the findings, in the same order, found on
// `target` (N). `context`: of the search.
void compare_bands(Verdict& verdict, std::span<const Term> terms, const LogRows& rows, const Eigen::VectorXd& target,
                   const SearchContext& context);

}  // namespace stiction::host
