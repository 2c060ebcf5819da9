// The logs that a command was given.
#pragma once

#include <string>
#include <vector>

#include "host/cli/progress.hpp"
#include "host/log/read_log.hpp"

namespace stiction::host {

// The logs of `files`, in their order, with progress where they are large. Throws LogError.
inline std::vector<Log> read_logs(const std::vector<std::string>& files) {
  Progress progress("reading logs", files.size());
  std::vector<Log> logs;
  for (const auto& file : files) {
    logs.push_back(read_log(file));
    progress.add();
  }
  return logs;
}

}  // namespace stiction::host
