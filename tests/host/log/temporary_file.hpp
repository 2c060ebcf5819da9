// A file of its own for each test, removed behind it.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace stiction::test {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& extension)
      : path_(std::filesystem::temp_directory_path() /
              ("stiction-log-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + extension)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  static inline int count = 0;
  std::filesystem::path path_;
};

}  // namespace stiction::test
