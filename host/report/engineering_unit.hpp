// The unit in which engineers of machine tools read a quantity, by its SI unit and its size.
#pragma once

#include <string>
#include <string_view>

namespace stiction::host {

struct EngineeringUnit {
  std::string unit;  // empty for a dimensionless number
  double factor;     // what one SI unit is in it
};

// `si` in the spelling of UDUNITS-2, "1" for dimensionless; `size` the largest absolute value that will be printed in
// the unit. A unit not known here stays as it is.
EngineeringUnit engineering_unit(std::string_view si, double size);

}  // namespace stiction::host
