// For the fuzzers: a machine from bytes that never touch a disk, and the least that must hold for any machine that the
// reader accepts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/machine/machine_file.hpp"

namespace stiction::fuzz {

// A file in memory with a path, replaced by each text.
class FileInMemory {
 public:
  FileInMemory();
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  void write(std::string_view text);
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

// Reads the file and, when it is accepted, runs the machine for a moment. A refusal that names its reason
// (sim::MachineFileError, sim::ConfigurationError) is right for any input; every other exception, and a machine that
// breaks the promises of run_briefly, ends the program as a finding.
void read_and_run(const FileInMemory& file, const sim::ReadOptions& options);

// Ten fast ticks: a plant at rest without command stays finite; in closed loop, in both signal policies, a plant that
// is no longer finite has stopped its drive with a fault.
void run_briefly(const sim::Machine& machine);

// Ends the program as a finding.
[[noreturn]] void finding(const std::string& what);

}  // namespace stiction::fuzz
