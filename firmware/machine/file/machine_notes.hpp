// What a machine file says twice, where the two do not quite agree: no error, but worth a sentence.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Whole sentences, each about one axis; none where all constants agree.
std::vector<std::string> machine_notes(const Machine& machine);

}  // namespace stiction::machine
