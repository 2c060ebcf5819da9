// The sentence at the head of an identification's report: what was determined, and how well it describes the records.
#pragma once

#include <string>

#include "host/identify/identification.hpp"

namespace stiction::host {

// One sentence, plain text: Coulomb friction and mass with their intervals where they are determined, else how many
// parameters are; the residual of the fit; what is not determined. `result`: with any parameters, or none;
// `file`: the axis as the machine file has it, whose values are named beside those that were identified; may be null.
std::string identification_sentence(const Identification& result, const machine::AxisModel* file = nullptr);

}  // namespace stiction::host
