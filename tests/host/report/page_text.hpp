// A report's page taken apart: its data, the arrays in them, its text without the chart library.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace stiction::host {

inline std::string between(const std::string& page, const std::string& open, const std::string& close) {
  const auto begin = page.find(open);
  if (begin == std::string::npos) return {};
  const auto content = begin + open.size();
  return page.substr(content, page.find(close, content) - content);
}

inline nlohmann::json data_of(const std::string& page) {
  return nlohmann::json::parse(between(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
}

inline std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

// The library names addresses, and asks for none of them. Empty when the page does not have the library.
inline std::string without_chart_library(std::string page) {
  const auto library = page.find("plotly.js (basic");
  if (library == std::string::npos) return {};
  const auto begin = page.rfind("<script>", library);
  page.erase(begin, page.find("</script>", begin) - begin);
  return page;
}

// The inverse of base64_floats().
inline std::vector<float> floats_of(const std::string& base64) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    group = group << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(group >> bits));
  }
  std::vector<float> values(bytes.size() / 4);
  std::memcpy(values.data(), bytes.data(), values.size() * 4);
  return values;
}

}  // namespace stiction::host
