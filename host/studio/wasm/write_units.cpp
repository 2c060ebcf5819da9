// Prints the source of unit_pairs.hpp: every pair of convertible units among the usual ones, those of the machine
// file's description and those that the files of the command line have. usage: write_units FILE...
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "firmware/machine/file/units.hpp"
#include "sim/machine_file.hpp"

namespace {

namespace machine = stiction::machine;

const char* const usual[] = {
    "1",       "%",       "m",       "mm",      "um",      "nm",       "cm",       "km",       "inch",      "rad",
    "mrad",    "urad",    "deg",     "arcmin",  "arcsec",  "rev",      "turn",     "s",        "ms",        "us",
    "ns",      "min",     "h",       "Hz",      "kHz",     "MHz",      "rpm",      "rev/min",  "rev/s",     "rad/s",
    "deg/s",   "rad/s^2", "deg/s^2", "rev/s^2", "rad/s^3", "deg/s^3",  "m/s",      "mm/s",     "m/min",     "mm/min",
    "m/s^2",   "mm/s^2",  "m/s^3",   "mm/s^3",  "kg",      "g",        "t",        "kg m^2",   "kg cm^2",   "g m^2",
    "N",       "kN",      "mN",      "N m",     "N.m",     "mN m",     "kN m",     "N s/m",    "N m s/rad", "N/m",
    "N/mm",    "N/um",    "kN/mm",   "N m/rad", "N m/deg", "kN m/rad", "N/A",      "N m/A",    "V",         "mV",
    "kV",      "A",       "mA",      "Ohm",     "mOhm",    "H",        "mH",       "uH",       "F",         "uF",
    "mF",      "W",       "kW",      "J",       "kJ",      "K",        "degC",     "K/W",      "1/s",       "1/min",
    "1/m",     "V s/m",   "V s/rad", "V/A",     "A/V",     "A s/m",    "A s/rad",  "V s",      "m/rad",     "mm/rad",
    "mm/deg",  "m/deg",   "mm/rev",  "m/rev",   "m/rad^2", "m/rad^3",  "mm/rad^2", "mm/rad^3", "mm/deg^2",  "rad/m",
    "deg/mm",  "rad/mm",  "deg/m",   "rad/m^2", "rad/m^3", "rad/rad",  "deg/deg",  "m/m",      "mm/mm",     "1/rad",
    "1/rad^2", "1/deg",   "1/deg^2", "1/m^2",   "1/mm",    "1/mm^2",   "MPa",      "GPa",      "Pa",        "kg/m",
    "N/V",     "N m/V"};

bool is_unit(const std::string& text) {
  try {
    machine::dimension_of(text);
    return true;
  } catch (const machine::UnitError&) {
    return false;
  }
}

// Of texts such as "2.5 mm" in a file.
void add_units_of(const std::string& text, std::set<std::string>& units) {
  for (std::size_t at = text.find('"'); at != std::string::npos; at = text.find('"', at + 1)) {
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string::npos || end - at > 64) continue;
    const std::string quantity = text.substr(at + 1, end - at - 1);
    const std::string unit(machine::unit_of(quantity));
    if (!unit.empty() && is_unit(unit)) units.insert(unit);
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::set<std::string> units;
  for (const char* unit : usual)
    if (is_unit(unit)) units.insert(unit);
  for (const auto& table : stiction::sim::machine_file_description())
    for (const auto& key : table.keys)
      if (!key.unit.empty() && is_unit(std::string(key.unit))) units.insert(std::string(key.unit));
  for (int k = 1; k < count; ++k) {
    std::ifstream file(arguments[k], std::ios::binary);
    add_units_of({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}, units);
  }
  std::map<std::string, std::vector<std::string>> alike;
  for (const auto& unit : units) alike[machine::dimension_of(unit)].push_back(unit);
  fmt::print(
      "#include \"host/studio/wasm/unit_pairs.hpp\"\n\nnamespace stiction::host {{\nnamespace {{\n\n"
      "constexpr UnitPair pairs[] = {{\n");
  for (const auto& [dimension, names] : alike)
    for (const auto& from : names)
      for (const auto& to : names) try {
          const double offset = machine::parse_quantity("0 " + from, to);
          fmt::print("    {{\"{}\", \"{}\", \"{}\", {:a}, {:a}}},\n", from, to, dimension,
                     machine::parse_quantity("1 " + from, to) - offset, offset);
        } catch (const machine::UnitError&) {  // angles are told from numbers
        }
  fmt::print(
      "}};\n\n}}  // namespace\n\nconst std::span<const UnitPair> unit_pairs(pairs);\n\n}}  // namespace "
      "stiction::host\n");
}
