// Results appear complete or not at all: files and folders are made under a temporary name beside their place and
// moved there at the end. What was not committed is removed, also when the programme is interrupted.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace stiction::host {

// Adds the option --out DIR, with the help `text`, to `command`; its value comes into `out`. A place that cannot hold a
// result is refused before anything runs. `several`: the folder gets a folder for each result.
CLI::Option* add_out(CLI::App& command, std::string& out, const std::string& text, bool several = false);

// Adds the option `name`, with the help `text`, to `command`: a file to write, whose path comes into `file`. What
// cannot be written is refused before anything runs.
CLI::Option* add_output_file(CLI::App& command, const std::string& name, std::string& file, const std::string& text);

class PendingFile {
 public:
  // Throws UsageError when `place` is a folder, lies in none, or must not be written.
  explicit PendingFile(std::filesystem::path place);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  const std::filesystem::path& path() const { return pending_; }  // write here
  void write(std::string_view content) const;                     // throws std::runtime_error
  // Calls `writer` with the path to write; what it throws names the place instead.
  void fill(const std::function<void(const std::filesystem::path&)>& writer) const;
  void commit();  // throws std::runtime_error

 private:
  std::filesystem::path place_;
  std::filesystem::path pending_;
  bool stream_;  // the place is a device or a pipe, which is not replaced but written
};

// A folder of results. It keeps a record of the files that commands made in it: a later result replaces these, and
// everything else in the folder stays.
class PendingFolder {
 public:
  // `command` that makes the result, "simulate circle". Throws UsageError when `place` is no folder, must not be
  // written, or holds files and none of a result.
  PendingFolder(std::filesystem::path place, std::string command);
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;
  ~PendingFolder();

  const std::filesystem::path& path() const { return pending_; }
  void write(std::string_view name, std::string_view content) const;  // throws std::runtime_error
  // Puts the files in place, in one step where the file system can; removes what the same command made here before and
  // does not make now. Throws UsageError, and changes nothing, where a file of that name is not by any command;
  // std::runtime_error.
  void commit();

 private:
  bool exchange(const std::vector<std::string>& leave) const;
  void replace_each(const std::vector<std::string>& outdated) const;

  std::filesystem::path place_;
  std::string command_;
  std::filesystem::path pending_;
  std::vector<std::filesystem::path> made_;  // folders above it, outermost first
  bool committed_ = false;
};

}  // namespace stiction::host
