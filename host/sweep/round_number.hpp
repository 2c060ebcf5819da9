// Numbers of a sweep as its rows and commands have them.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <string>

namespace stiction::host {

// `value` with nine significant digits: a command line that a reader can type, and the same number on processors whose
// logarithms differ in the last place.
inline double round_number(double value) { return std::strtod(fmt::format("{:.9g}", value).c_str(), nullptr); }

// "200 kg" with as many digits as read back to the same number; the number alone where `unit` is empty.
inline std::string quantity_text(double number, const std::string& unit) {
  return unit.empty() ? fmt::format("{}", number) : fmt::format("{} {}", number, unit);
}

}  // namespace stiction::host
