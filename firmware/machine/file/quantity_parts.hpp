// The parts of a quantity "NUMBER UNIT" that need no database of units: programmes with one (units.cpp) and pages
// without (host/studio/wasm/units.cpp) read numbers and convert alike.
#pragma once

#include <string_view>

namespace stiction::machine {

// `text` without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

// The number that `text` begins with; `unit` becomes the rest, without blanks. Throws UnitError for no finite number
// and for a unit that no blank parts from it.
double split_quantity(std::string_view text, std::string_view& unit);

// `number` of a unit in one of which it has `factor`. A factor like 1e-6 is no double, its inverse is: dividing by that
// rounds once, as the compiler's 62.5e-6 does.
double scaled(double number, double factor);

}  // namespace stiction::machine
