// `stiction diagnose --identify`: mass and friction from the training logs, in place of those of a machine file that
// was never identified.
#pragma once

#include <string>
#include <vector>

#include "host/cli/diagnose_output.hpp"
#include "host/diagnose/diagnose.hpp"

namespace stiction::host {

// A folder for intermediate machine files, which are named as the user's own is; gone with it.
class IntermediateFolder {
 public:
  IntermediateFolder();
  IntermediateFolder(const IntermediateFolder&) = delete;
  IntermediateFolder& operator=(const IntermediateFolder&) = delete;
  ~IntermediateFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The training logs of a diagnosis: where none is held out, their first two thirds. `input`: its logs.
std::vector<Log> training_logs(const DiagnoseInput& input);

// Identifies the axis of `input` from its training logs, writes the machine file with the result into `folder`, and
// makes that file the one that is diagnosed: in `input` and in `file`. Returns what was identified, with its intervals.
// `command`: the command line, for the head of the file. Throws LogError, machine::MachineFileError.
std::vector<StartValue> start_from_identified(DiagnoseInput& input, DiagnosedFile& file,
                                              const IntermediateFolder& folder, const std::string& command);

}  // namespace stiction::host
