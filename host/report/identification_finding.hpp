// The sentence at the head of an identification's report: what was determined, and how well it describes the records.
#pragma once

#include <string>

#include "host/identify/identification.hpp"

namespace stiction::host {

// One sentence, plain text: Coulomb friction and mass with their intervals where they are determined, else how many
// parameters are; the residual of the fit; what is not determined. `result`: with any parameters, or none.
std::string identification_sentence(const Identification& result);

}  // namespace stiction::host
