// The reference of all keys of a machine file as Markdown, made from their descriptions.
#pragma once

#include <string>

namespace stiction::sim {

// One section a table of the file, one row a key: unit, range, default, text.
std::string reference_page();

}  // namespace stiction::sim
