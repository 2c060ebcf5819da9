// The logs that a command was given.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/cli/progress.hpp"
#include "host/log/read_log.hpp"
#include "host/log/stretches.hpp"

namespace stiction::host {

// The logs of `files`, in their order, one a stretch of a record with gaps, with progress where they are large. Throws
// LogError.
inline std::vector<Log> read_logs(const std::vector<std::string>& files) {
  Progress progress("reading logs", files.size());
  std::vector<Log> logs;
  for (const auto& file : files) {
    for (auto& stretch : stretches_of(read_log(file))) logs.push_back(std::move(stretch));
    progress.add();
  }
  return logs;
}

}  // namespace stiction::host
