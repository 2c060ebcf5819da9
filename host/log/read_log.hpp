// A log from a file of any of the program's formats.
#pragma once

#include <filesystem>

#include "host/log/log.hpp"

namespace stiction::host {

// The format is told by the content, not by the file's name. Throws LogError.
Log read_log(const std::filesystem::path& file);

}  // namespace stiction::host
