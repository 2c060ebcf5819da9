// The terms that a search chose, off its grids: nonlinear parameters by golden section, weights and covariances of all
// together.
#pragma once

#include "host/diagnose/search/search.hpp"

namespace stiction::host {

// Sets nonlinear parameter, weights and covariance of each term by the whitened rows of `searched`; returns the
// residual force that the terms leave (N, of the rows, not whitened). `context`: of the search.
Eigen::VectorXd refine(const LogRows& rows, const Evidence& searched, const SearchContext& context,
                       std::vector<Term>& terms);

}  // namespace stiction::host
