// JSON that the studio's page alone reads, without a library of it.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace stiction::host::studio_json {

inline std::string text(std::string_view of) {
  std::string result = "\"";
  for (const char c : of) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < ' ')
      result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      result += c;
  }
  return result + '"';
}

// JSON has no infinity.
inline std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }
inline std::string number(const std::optional<double>& value) { return value ? number(*value) : "null"; }
inline std::string truth(bool value) { return value ? "true" : "false"; }

// `each` of the `items`, as a list.
template <class Items, class Text>
std::string list(const Items& items, const Text& each) {
  std::string result = "[";
  for (const auto& item : items) result += (result.size() > 1 ? "," : "") + each(item);
  return result + "]";
}

}  // namespace stiction::host::studio_json
