// What is no error of a machine file, but worth a sentence: what it says twice and not quite alike, and a rotary axis
// that the firmware's number formats do not hold.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Whole sentences, each about one axis; none where all constants agree.
std::vector<std::string> machine_notes(const Machine& machine);

}  // namespace stiction::machine
