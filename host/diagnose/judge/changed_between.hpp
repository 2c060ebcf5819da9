// Whether training and held-out records are of one state of the machine: a workpiece that was added, a different day's
// offset or oil show as a mass, a constant force, a Coulomb level or a viscous friction that is not the same in both.
// No effect's amplitude can be compared before that is known.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// Rows of records of one use with what the file and the causes found leave of their force.
struct StateRows {
  const LogRows& rows;
  const Eigen::VectorXd& left;  // N
};

// A parameter that has changed: held-out data have so much more of the candidate's column.
struct StateChange {
  std::size_t candidate;
  double training = 0.0, held_out = 0.0;  // weights of its column: what the records have beyond the file
  double error = 0.0;                     // standard error of their difference
  Eigen::VectorXd force;                  // N, of the difference in the held-out rows
};

// What differs by more than chance and than the training records differ among themselves, at a level of 1 % for all
// parameters together, and moves the held-out force by 1 % rms or more. Blocks of rows are one piece of evidence each.
// `training`, `held_out`: either set's rows; `context` of the search; `terms`: what it found, already taken off what is
// left.
std::vector<StateChange> changes_between(const StateRows& training, const StateRows& held_out,
                                         const SearchContext& context, std::span<const Term> terms);

// For readers: parameters as the file has them, with what they are in either set of records.
ChangedParameter changed_parameter(const SearchContext& context, const StateChange& change);

}  // namespace stiction::host
