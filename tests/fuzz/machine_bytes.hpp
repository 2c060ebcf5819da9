// For the fuzzers: the least that must hold for any machine that the reader accepts, and any bytes as a file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "firmware/machine/file/machine_file.hpp"

namespace stiction::fuzz {

// A file with a path that never touches a disk.
class FileInMemory {
 public:
  FileInMemory();
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  void replace_by(std::string_view text);
  const std::filesystem::path& path() const { return path_; }

 private:
  int descriptor_;
  std::filesystem::path path_;
};

// Valid machines with one axis that has everything its motor model allows, "synchronous", "dc" or "force", or a shaft
// between motor and load, "elastic".
std::filesystem::path valid_machine(const std::string& name);

// Reads the file and, when it is accepted, runs the machine for a moment. A refusal that names its reason
// (sim::MachineFileError, sim::ConfigurationError) is right for any input; every other exception, and a machine that
// breaks the promises of run_briefly, ends the program as a finding.
// `made`: what a fuzzer made of its bytes, for the message of a finding.
void read_and_run(const std::filesystem::path& file, const machine::ReadOptions& options, const std::string& made = {});

// Ten fast ticks: a plant without effects at rest without command stays finite; in closed loop, in both signal
// policies, a plant that is no longer finite has stopped its drive with a fault.
void run_briefly(const machine::Machine& machine);

// Ends the program as a finding.
[[noreturn]] void finding(const std::string& what);

}  // namespace stiction::fuzz
