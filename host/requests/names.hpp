// Names in a request: what is none of the known ones is refused with all of them and the nearest right spelling.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stiction::host {

// The end of a message, `; did you mean 'circle'?`, for the nearest of `known` to `name`; empty where none is near.
std::string nearest_words(std::string_view name, const std::vector<std::string>& known);

// Throws UsageError "OPTION: found 'NAME'; expected EXPECTED: a, b; did you mean 'a'?" unless `name` is among `known`.
// `option` as typed, "--axis"; `expected` says what the names are, "an axis of emps".
void require_known(std::string_view option, const std::string& name, std::string_view expected,
                   const std::vector<std::string>& known);

// Names of the axes of a machine, for messages and choices.
template <class Machine>
std::vector<std::string> axis_names(const Machine& machine) {
  std::vector<std::string> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  return names;
}

}  // namespace stiction::host
