// The vocabulary as docs/effects.md shows it.
#pragma once

#include <string>

namespace stiction::sim {

// Two tables: each effect with its keys, and each pair of effects that may be confused with the experiment that
// separates it. Links start at the folder docs.
std::string effects_markdown();

}  // namespace stiction::sim
