#include "sim/cam/quantity_text.hpp"

#include <fmt/format.h>

#include "firmware/machine/file/units.hpp"

namespace stiction::sim::cam {

std::string quantity_text(double value, std::string_view si, std::string_view shown) {
  if (!shown.empty()) {
    const auto text = machine::format_quantity(value, si, shown);
    if (machine::parse_quantity(text, si) == value) return fmt::format("\"{}\"", text);
  }
  if (si == "1") return fmt::format("{}", value);
  return fmt::format("\"{} {}\"", value, si);
}

std::string number_text(double value) {
  auto text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace stiction::sim::cam
