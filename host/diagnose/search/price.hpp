// What a term of a search has to be worth before it is called a cause.
#pragma once

#include <algorithm>
#include <cmath>

#include "host/diagnose/classes/candidate.hpp"
#include "host/diagnose/statistics/level.hpp"

namespace stiction::host {

// What a name must have against all that has none: nats.
inline const double sure = std::log(loss_ratio);
// Of the strongest term's log evidence: so much may be left of how that one was described.
constexpr double of_strongest = 0.02;

// Number of independent values of a candidate's nonlinear parameter that were tried. `context`: of the search;
// `candidate`: index in candidates(); `shape`: the value, which tells a place from a knot.
inline double trials_of(const SearchContext& context, std::size_t candidate, double shape) {
  const auto& of = candidates()[candidate];
  if (of.places != nullptr && PlaceScan::is_place(shape)) return of.places(context).trials;
  if (of.scan != nullptr) return static_cast<double>(std::max<std::size_t>(of.scan(context).trials, 1));
  return std::max(of.trials, of.shape ? 3.0 : 1.0);
}

// Log odds beforehand that the candidate is there with one value of its nonlinear parameter: one of all is as likely as
// none, each value as likely as the next; less what records of the exact machine say for it. `context`, `candidate` and
// `shape`: as above.
inline double log_prior_of(const SearchContext& context, std::size_t candidate, double shape) {
  const double price = context.prices.empty() ? 0.0 : context.prices[candidate];
  return -std::log(static_cast<double>(candidates().size()) * trials_of(context, candidate, shape)) - price;
}

}  // namespace stiction::host
