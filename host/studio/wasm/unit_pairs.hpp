// What UDUNITS-2 says of the units that motion and machine files have, as data that write_units.cpp makes at the desk.
#pragma once

#include <span>
#include <string_view>

namespace stiction::host {

struct UnitPair {
  std::string_view from, to, dimension;  // the dimension of both, in SI base units
  double factor;                         // one `from` in `to`
  double offset;                         // zero of `from` in `to`; of temperatures alone, whose degrees are alike
};

extern const std::span<const UnitPair> unit_pairs;

}  // namespace stiction::host
