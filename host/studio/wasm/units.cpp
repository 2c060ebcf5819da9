// Quantities without the database of UDUNITS-2: the pairs of units that motion and machine files have, with what
// UDUNITS-2 says of them at the desk (write_units.cpp), so that a page reads the same doubles.
#include "firmware/machine/file/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "host/studio/wasm/unit_pairs.hpp"

namespace stiction::machine {
namespace {

constexpr std::string_view blanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

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

// As the desk does (firmware/machine/file/units.cpp): a factor like 1e-6 is no double, its inverse is.
double convert(const host::UnitPair& pair, double number) {
  if (pair.offset != 0.0) return number + pair.offset;
  const double inverse = std::round(1.0 / pair.factor);
  if (std::abs(pair.factor) < 1.0 && std::abs(inverse * pair.factor - 1.0) < 1e-14) return number / inverse;
  return number * pair.factor;
}

double split(std::string_view text, std::string_view& unit) {
  text = trimmed(text);
  const std::size_t end = text.find_first_of(" \t%");
  const std::string digits(text.substr(0, end));
  char* stop = nullptr;
  const double number = std::strtod(digits.c_str(), &stop);
  const bool decimal = digits.find_first_not_of("+-.0123456789eE") == std::string::npos;
  if (digits.empty() || !decimal || *stop != '\0') throw UnitError("not NUMBER UNIT");
  if (!std::isfinite(number)) throw UnitError("beyond the range of numbers");
  unit = end == std::string_view::npos ? std::string_view() : trimmed(text.substr(end));
  return number;
}

}  // namespace

double parse_quantity(std::string_view text, std::string_view si_unit) {
  std::string_view unit;
  const double number = split(text, unit);
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

std::string_view unit_of(std::string_view quantity) {
  std::string_view unit;
  try {
    split(quantity, unit);
  } catch (const UnitError&) {
    return {};
  }
  return unit;
}

std::string dimension_of(std::string_view unit) {
  for (const auto& pair : host::unit_pairs)
    if (pair.from == unit) return std::string(pair.dimension);
  throw UnitError(fmt::format("unknown unit \"{}\"", unit));
}

}  // namespace stiction::machine
