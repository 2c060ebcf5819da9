// Names that an option may take: what is none of them is refused with all of them and the nearest right spelling.
#pragma once

#include <CLI/CLI.hpp>
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

// For options that take one of `names`; the help lists them as {a,b}.
CLI::Validator one_of(const std::vector<std::string>& names);

// For options that take a whole number of 64 bits, such as a seed: CLI11 takes -1 for the largest one.
CLI::Validator whole_number();

// For options that take a whole number from `least` to `most`.
CLI::Validator whole_number_between(int least, int most);

// Names of the axes of a machine, for messages and choices.
template <class Machine>
std::vector<std::string> axis_names(const Machine& machine) {
  std::vector<std::string> names;
  for (const auto& axis : machine.axes) names.push_back(axis.name);
  return names;
}

}  // namespace stiction::host
