// What writing a file safely needs of the operating system, so that a test can put a disk behind it that loses power.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stiction::drive {

// Something that is no file is in its place. what() names it.
class NoParameterFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// All throw std::system_error, whose what() says what could not be done, or NoParameterFile where a folder, FIFO or
// device is in the place of a file. No file is reached through a symbolic link.
class FileOperations {
 public:
  virtual ~FileOperations() = default;

  // The bytes of a file, somewhat more than 1 MiB of them at most; none where there is no file.
  virtual std::optional<std::string> read(const std::filesystem::path& file) = 0;
  // Makes the file, or empties it.
  virtual void create(const std::filesystem::path& file) = 0;
  virtual void append(const std::filesystem::path& file, std::string_view bytes) = 0;
  // Returns when the bytes are on the disk.
  virtual void sync(const std::filesystem::path& file) = 0;
  // Returns when the names in the folder are.
  virtual void sync_folder(const std::filesystem::path& folder) = 0;
  virtual void rename(const std::filesystem::path& from, const std::filesystem::path& to) = 0;
  // A second name for the same bytes.
  virtual void link(const std::filesystem::path& file, const std::filesystem::path& name) = 0;
  // Nothing where there is no file.
  virtual void remove(const std::filesystem::path& file) = 0;
};

// Those of the system that this runs on.
FileOperations& system_files();

}  // namespace stiction::drive
