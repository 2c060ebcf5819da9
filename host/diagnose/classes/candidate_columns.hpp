// A candidate's columns in the rows of all records: its regressors, filtered as the force is.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "host/diagnose/classes/candidate.hpp"
#include "host/identify/log_rows.hpp"

namespace stiction::host {

// A candidate with a value of its nonlinear parameter.
struct CandidateAt {
  const Candidate* candidate;
  double shape;
};

// As one for all records (N per unit of weight). `rows` of all records; `context` of the search; the `candidate` at
// this `shape`.
std::vector<Eigen::VectorXd> shared_columns(const LogRows& rows, const SearchContext& context,
                                            const Candidate& candidate, double shape);
// The same, and of those that have weights of their own in each record in the rows of that one alone. `context` of the
// search; the `candidate` at this `shape`.
std::vector<Eigen::VectorXd> group_columns(const LogRows& rows, const SearchContext& context,
                                           const Candidate& candidate, double shape);
// Those of several trials, which takes less time together. `rows` and `context` as above; `trials`: candidates with
// their shapes.
std::vector<std::vector<Eigen::VectorXd>> group_columns(const LogRows& rows, const SearchContext& context,
                                                        const std::vector<CandidateAt>& trials);
// Their sum with these weights (N). `rows`, `context`, `candidate` and `shape` as above; `coefficients`: the weights.
Eigen::VectorXd weighted_columns(const LogRows& rows, const SearchContext& context, const Candidate& candidate,
                                 double shape, const Eigen::VectorXd& coefficients);

}  // namespace stiction::host
