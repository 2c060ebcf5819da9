// The sentence at the head of an experiment's report: what was found, and what it is worth.
#pragma once

#include <string>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// One sentence, as typeset() prints it: the decisive figures of the experiment and, where the machine file expects
// figures, how many are as expected. `result`: with any figures, or none; `machine`: whose friction model in use is
// spoken of where the result has it.
std::string experiment_sentence(const sim::ExperimentResult& result, const machine::Machine& machine);

}  // namespace stiction::host
