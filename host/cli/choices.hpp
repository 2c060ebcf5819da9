// Names that an option may take: what is none of them is refused with all of them and the nearest right spelling.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/requests/names.hpp"

namespace stiction::host {

// For options that take one of `names`; the help lists them as {a,b}.
CLI::Validator one_of(const std::vector<std::string>& names);

// For options that take a whole number of 64 bits, such as a seed: CLI11 takes -1 for the largest one.
CLI::Validator whole_number();

// For options that take a whole number from `least` to `most`.
CLI::Validator whole_number_between(int least, int most);

// For options that take a number from `least` to `most`.
CLI::Validator number_between(double least, double most);

}  // namespace stiction::host
