// The right spelling for a name that nobody knows. Distance: Damerau's and Levenshtein's (insertions, deletions,
// replacements and exchanges of neighbours, each 1), without regard to case, blanks, hyphens and underscores.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stiction::machine {

// The one of `known` nearest to `name` when a slip of the pen explains the difference (one slip, and one more for every
// five characters), or the only one that `name` abbreviates; empty otherwise. Takes time in proportion to the product
// of both lengths for each known name.
std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& known);

// The end of a message that lists the names: `; did you mean "mass"?` for the nearest of `known` to `name`; empty where
// none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& known);

}  // namespace stiction::machine
