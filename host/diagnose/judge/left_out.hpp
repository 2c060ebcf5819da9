// Whether a cause is found without each of the training logs as well. One that a single log makes is that log's: a
// collision, a warm-up, a clock that slipped.
#pragma once

#include <cstddef>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// Looks for causes as the search did that found `terms`, at its prices and its replays, with one log after the other
// left out; of very many, with one part of them after the other. Returns, one a term, in how many of these searches its
// cause is named; empty for a single log. `rows`: of the search; `target`: N, its residual force; `context`: of it.
std::vector<NamedIn> named_without_each_log(const LogRows& rows, const Eigen::VectorXd& target,
                                            const SearchContext& context, const std::vector<Term>& terms);

}  // namespace stiction::host
