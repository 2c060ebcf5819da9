// The causes as the machine shows them in closed loop: beginning with the strongest, each is described by runs of the
// simulated machine, and another joins it only where it explains what those runs leave. What the columns of a search
// describe coarsely leaves a remainder, which other columns take: in closed loop it is gone.
#pragma once

#include <span>
#include <vector>

#include "host/diagnose/judge/closed_loop_refinement.hpp"

namespace stiction::host {

struct ClosedLoopDescription {
  std::vector<Term> terms;        // those that are needed
  std::vector<Finding> findings;  // theirs, with parameters and standard errors
  std::vector<Term> unnamed;      // those without a name that are needed
  std::vector<Term> remainders;   // what was not
};

// `named`, `unnamed`: terms of a search over `rows` and `target` (N); `left`: what all of them leave; `responses`: of
// these records; none where they cannot run: then the terms stay. `context`: of the search.
ClosedLoopDescription describe_in_closed_loop(std::vector<Term> named, std::vector<Term> unnamed,
                                              std::span<EffectResponse> responses, const LogRows& rows,
                                              const Eigen::VectorXd& target, const Eigen::VectorXd& left,
                                              const SearchContext& context);

}  // namespace stiction::host
