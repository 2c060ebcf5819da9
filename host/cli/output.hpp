// Results appear complete or not at all: files and folders are made under a temporary name beside their place and
// moved there at the end. What was not committed is removed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stiction::host {

class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path place);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();

  const std::filesystem::path& path() const { return pending_; }  // write here
  void commit();                                                  // throws std::runtime_error

 private:
  std::filesystem::path place_;
  std::filesystem::path pending_;
};

class PendingFolder {
 public:
  // Throws UsageError when `place` exists and is neither empty nor an earlier result.
  explicit PendingFolder(std::filesystem::path place);
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;
  ~PendingFolder();

  const std::filesystem::path& path() const { return pending_; }
  void write(std::string_view name, std::string_view content) const;  // throws std::runtime_error
  // Replaces an earlier result at the place in one step. Throws std::runtime_error.
  void commit();

 private:
  std::filesystem::path place_;
  std::filesystem::path pending_;
};

}  // namespace stiction::host
