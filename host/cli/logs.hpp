// The logs that a command was given.
#pragma once

#include <string>
#include <vector>

#include "host/cli/log_input.hpp"

namespace stiction::host {

// The logs of `files`, in their order, with progress where they are large. `columns`: of files without header
// (log_input.hpp). Throws LogError.
inline std::vector<Log> read_logs(const std::vector<std::string>& files, const std::string& columns = {}) {
  std::vector<Log> logs;
  for (const auto& file : files) logs.push_back(read_log_shown(file, columns));
  return logs;
}

}  // namespace stiction::host
