// The reference of all keys of a machine file as Markdown, made from their descriptions.
#pragma once

#include <string>

#include "firmware/machine/model/value_table.hpp"

namespace stiction::machine {

// One section a table of the file, one row a key: unit, range, default, text.
std::string reference_page(const Vocabulary& vocabulary);

}  // namespace stiction::machine
