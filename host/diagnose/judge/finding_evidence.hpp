// What the data say for a finding, as the page shows it: shares, probability, what it may be confused with, and what
// held-out data show of it.
#pragma once

#include <vector>

#include "host/diagnose/judge/held_out_amplitude.hpp"
#include "host/diagnose/search/search.hpp"
#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// "1.02 +- 0.05": times the fitted amplitude.
std::string repeated(const HeldOutAmplitude& held_out_amplitude);

// Completes a `finding` that has its parameters with what the data say for its `term`. `gain` and `held_out_amplitude`
// of the held-out data; `blocks`: of how many blocks of rows its p-value is.
void give_evidence(Finding& finding, const Term& term, const HoldoutGain& gain,
                   const HeldOutAmplitude& held_out_amplitude, std::size_t blocks);

// The table that extends the machine by a term without a name. `context` of the search; `gain` and
// `held_out_amplitude` of the held-out data.
Finding map_finding(const SearchContext& context, const Term& term, const HoldoutGain& gain,
                    const HeldOutAmplitude& held_out_amplitude);

// What the terms without a name look like, together. `context` of the search.
Unexplained unexplained_by(const SearchContext& context, const std::vector<Term>& unnamed);

}  // namespace stiction::host
