// A name in a file against the names that are known.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/file/document.hpp"

namespace stiction::machine {

// Refuses `name`, the value of `key` in `table` at `path` of `document`, where it is not among `known`; `what` says
// what a known one is. Throws MachineFileError.
void check_name(const Document& document, const toml::table& table, const std::string& path, std::string_view key,
                std::string_view name, const std::vector<std::string_view>& known, std::string_view what);

}  // namespace stiction::machine
