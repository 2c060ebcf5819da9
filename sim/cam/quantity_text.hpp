// Numbers and quantities as files have them: read back, they are the same doubles.
#pragma once

#include <string>
#include <string_view>

namespace stiction::sim::cam {

// `value`, in the unit `si`, as TOML: in the unit `shown` where that reads back as the same double, else in `si`. An
// empty `shown`: none but `si`. A number alone where `si` is "1".
std::string quantity_text(double value, std::string_view si, std::string_view shown);

// A number as TOML reads it back as a double: with a point or an exponent.
std::string number_text(double value);

}  // namespace stiction::sim::cam
