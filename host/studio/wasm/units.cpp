// Quantities without the database of UDUNITS-2: the pairs of units that motion and machine files have, with what
// UDUNITS-2 says of them at the desk (write_units.cpp), so that a page reads the same doubles.
#include "firmware/machine/file/units.hpp"

#include <fmt/format.h>

#include <cmath>

#include "firmware/machine/file/quantity_parts.hpp"
#include "host/studio/wasm/unit_pairs.hpp"

namespace stiction::machine {
namespace {

bool known(std::string_view unit) {
  for (const auto& pair : host::unit_pairs)
    if (pair.from == unit) return true;
  return false;
}

const host::UnitPair& pair_of(std::string_view from, std::string_view to) {
  for (const auto& pair : host::unit_pairs)
    if (pair.from == from && pair.to == to) return pair;
  if (!known(from))
    throw UnitError(fmt::format("unit \"{}\", which the page does not know: `stiction cam studio` reads all", from));
  throw UnitError(fmt::format("a unit \"{}\", which is no {}", from, to));
}

double convert(const host::UnitPair& pair, double number) {
  return pair.offset != 0.0 ? number + pair.offset : scaled(number, pair.factor);
}

}  // namespace

double parse_quantity(std::string_view text, std::string_view si_unit) {
  std::string_view unit;
  const double number = split_quantity(text, unit);
  if (unit.empty()) {
    if (si_unit != "1") throw UnitError("no unit");
    return number;
  }
  const double value = unit == si_unit ? number : convert(pair_of(unit, si_unit), number);
  if (!std::isfinite(value)) throw UnitError("beyond the range of numbers");
  return value;
}

std::string format_quantity(double value, std::string_view si_unit, std::string_view unit) {
  if (unit.empty() || unit == "1") return fmt::format("{}", value);
  return fmt::format("{:.15g} {}", si_unit == unit ? value : convert(pair_of(si_unit, unit), value), unit);
}

std::string dimension_of(std::string_view unit) {
  for (const auto& pair : host::unit_pairs)
    if (pair.from == unit) return std::string(pair.dimension);
  throw UnitError(fmt::format("unknown unit \"{}\"", unit));
}

}  // namespace stiction::machine
