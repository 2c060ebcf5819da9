// The words of what rotates: descriptions of keys are written for a linear axis, and a rotary one has torques, inertias
// and angles in place of forces, masses and lengths. Units and keys: coordinate.hpp.
#pragma once

#include <string>
#include <string_view>

#include "firmware/machine/model/coordinate.hpp"

namespace stiction::machine {

// `text`, the description of a key or a part of one, in the words of `coordinate`: as it is for a linear one. Takes
// whole words alone.
std::string in_own_words(std::string_view text, const Coordinate& coordinate);

}  // namespace stiction::machine
