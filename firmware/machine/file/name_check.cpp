#include "firmware/machine/file/name_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/machine/file/description.hpp"
#include "firmware/machine/file/nearest_name.hpp"

namespace stiction::machine {

void check_name(const Document& document, const toml::table& table, const std::string& path, std::string_view key,
                std::string_view name, const std::vector<std::string_view>& known, std::string_view what) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  document.fail(table.get(key)->source(), join_key(path, key), fmt::format("\"{}\"", name),
                fmt::format("{}: {}{}", what, quoted_list(known), did_you_mean(name, known)));
}

}  // namespace stiction::machine
