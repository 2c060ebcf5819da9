// Foreign text inside error messages: short, on one line, printable.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace stiction::host {

// `text` with control characters as \xNN, cut after `most` bytes.
inline std::string excerpt(std::string_view text, std::size_t most = 40) {
  std::string out;
  for (const char c : text.substr(0, most)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += c;
  }
  if (text.size() > most) out += "...";
  return out;
}

}  // namespace stiction::host
