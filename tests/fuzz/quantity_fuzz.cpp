// Any text as a quantity, in every unit that a machine file has.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>

#include "firmware/machine/file/units.hpp"
#include "sim/machine_file.hpp"
#include "tests/fuzz/machine_bytes.hpp"

namespace stiction::fuzz {
namespace {

std::set<std::string> units_of_machine_files() {
  std::set<std::string> units;
  for (const auto& table : sim::machine_file_description())
    for (const auto& key : table.keys) {
      if (!key.unit.empty()) units.insert(key.unit);
      if (!key.unit_of_force_motor.empty()) units.insert(key.unit_of_force_motor);
    }
  return units;
}

bool has_control_character(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; });
}

// What is accepted is finite, is all that the text says, and means the same when it is written in its own unit again.
void check(std::string_view text, const std::string& si_unit) {
  double value = 0.0;
  try {
    value = machine::parse_quantity(text, si_unit);
  } catch (const machine::UnitError&) {
    return;
  }
  if (!std::isfinite(value)) finding(fmt::format("accepted in {} as {}", si_unit, value));
  if (has_control_character(text)) finding("accepted with a control character");
  // Beyond these the 15 digits of the text may fall out of the range of numbers.
  if (value != 0.0 && !(std::abs(value) > 1e-200 && std::abs(value) < 1e200)) return;
  const auto again_text = machine::format_quantity(value, si_unit, machine::unit_of(text));
  double again = 0.0;
  try {
    again = machine::parse_quantity(again_text, si_unit);
  } catch (const machine::UnitError& error) {
    finding(fmt::format("written again as \"{}\" it is refused: {}", again_text, error.what()));
  }
  // 1e3: the zero of degC lies 273 K off, at whose rounding small values end.
  if (!(std::abs(again - value) <= 1e-13 * (std::abs(value) + 1e3)))
    finding(fmt::format("{} {} became \"{}\" and then {}", value, si_unit, again_text, again));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto units = units_of_machine_files();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto& unit : units) check(text, unit);
  return 0;
}

}  // namespace stiction::fuzz
