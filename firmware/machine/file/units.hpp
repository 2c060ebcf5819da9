// Quantities at the edge of the program: text "NUMBER UNIT" outside, SI inside. The units are those of UDUNITS-2
// (https://docs.unidata.ucar.edu/udunits); its database must be installed (Debian: libudunits2-data).
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace stiction::machine {

// What is wrong with a quantity. what() completes 'found "3 A" (...)', e.g. "dimension A, not kg".
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The value of `text`, in `si_unit`. A number alone is a quantity only where `si_unit` is "1". Beyond the dimension,
// an angle is told from a number: "3000 rpm" is no frequency in Hz. A decimal prefix costs no rounding: "62.5 us" is
// the double 62.5e-6. Throws UnitError for anything but a finite number and a unit of that dimension.
double parse_quantity(std::string_view text, std::string_view si_unit);

// `value` (in `si_unit`) written in `unit`, e.g. format_quantity(62.5e-6, "s", "us") is "62.5 us". Throws UnitError.
std::string format_quantity(double value, std::string_view si_unit, std::string_view unit);

// The unit of "NUMBER UNIT"; empty when there is none.
std::string_view unit_of(std::string_view quantity);

// The dimension of a unit in SI base units, e.g. "kg s^-1" for "N s/m"; "1" for none. Throws UnitError.
std::string dimension_of(std::string_view unit);

}  // namespace stiction::machine
