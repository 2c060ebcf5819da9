// Terms that held-out data speak against are withdrawn.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/diagnose/judge/holdout.hpp"

namespace stiction::host {

struct Withdrawn {
  std::size_t candidate;
  std::string why;
};

// Withdraws the term that held-out data speak against most, until they do against none and not against all of them
// together; returns those. `data`: held out; `terms`: of the search, those that hold remain; `maps`: terms without a
// name that the machine is extended by, beside them.
std::vector<Withdrawn> keep_what_holds(const HeldOutData& data, std::vector<Term>& terms, std::span<const Term> maps);

// The figures of named `terms` and, behind them, of those `maps` that the held-out `data` confirm: the others are taken
// out.
HeldOutFigures keep_confirmed_maps(const HeldOutData& data, const std::vector<Term>& terms, std::vector<Term>& maps);

}  // namespace stiction::host
