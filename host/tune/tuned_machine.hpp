// The machine file with the friction compensation that was found.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/tune/tuning_result.hpp"

namespace stiction::host {

// Text of a machine file: `file` with `set` (ReadOptions) and the compensations. Throws sim::MachineFileError. `all`:
// the compensations of each axis; `logs`: their names, and `command`, the command line, for the head of the file.
std::string tuned_machine(const std::filesystem::path& file, const std::vector<std::string>& set,
                          const TunedCompensations& all, const std::vector<std::string>& logs,
                          const std::string& command);

}  // namespace stiction::host
