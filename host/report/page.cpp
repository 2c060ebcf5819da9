// Filling a page template and packing numbers into it: see page.hpp.
#include "host/report/page.hpp"

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <vector>

#include "host/report/base64.hpp"

namespace stiction::host {

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string json_for_script(const nlohmann::ordered_json& json) {
  const std::string plain = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(plain.size());
  for (const char c : plain) {
    if (c == '<')
      escaped += "\\u003c";  // only ever inside a JSON string
    else
      escaped += c;
  }
  return escaped;
}

std::string base64_floats(std::span<const float> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * 4);
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
  return base64(bytes);
}

std::string fill_template(std::string_view page, const std::map<std::string, std::string, std::less<>>& texts) {
  std::string filled;
  std::set<std::string_view> used;
  for (std::size_t at = 0;;) {
    const std::size_t open = page.find("{{", at);
    filled += page.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    if (close == std::string_view::npos) throw std::invalid_argument("a template's marker does not end");
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto text = texts.find(name);
    if (text == texts.end()) throw std::invalid_argument("no text for the template's marker " + std::string(name));
    filled += text->second;
    used.insert(name);
    at = close + 2;
  }
  for (const auto& [name, text] : texts)
    if (!used.contains(name)) throw std::invalid_argument("the template has no marker " + name);
  return filled;
}

}  // namespace stiction::host
