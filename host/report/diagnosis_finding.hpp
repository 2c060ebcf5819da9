// The sentence at the head of a diagnosis' report: which causes were found, and what they are worth.
#pragma once

#include <string>

#include "host/diagnose/verdict/verdict.hpp"

namespace stiction::host {

// One sentence, plain text: the causes with what they take from the deviation of simulation and machine on data that
// was not used; or that the simulation agrees, or that what is left has no known cause. `verdict`: of logs or of the
// machine file's own rows.
std::string diagnosis_sentence(const Verdict& verdict);

// A deviation of the position as reports print it, with two digits. `linear`: m, of any sign; `shown`: of the axis.
std::string deviation_text(double linear, const ShownQuantity& shown);

// A share as reports print it, in percent without its sign. `share`: 1 is all.
std::string percent(double share);

}  // namespace stiction::host
