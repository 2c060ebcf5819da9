// The logs that a command was given.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/cli/log_input.hpp"
#include "host/log/stretches.hpp"

namespace stiction::host {

// The logs of `files`, in their order, one a stretch of a record with gaps, with progress where they are large.
// `columns`: of files without header (log_input.hpp). Throws LogError.
inline std::vector<Log> read_logs(const std::vector<std::string>& files, const std::string& columns = {}) {
  std::vector<Log> logs;
  for (const auto& file : files)
    for (auto& stretch : stretches_of(read_log_shown(file, columns))) logs.push_back(std::move(stretch));
  return logs;
}

}  // namespace stiction::host
