#include "firmware/stictiond/file_operations.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace stiction::drive {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw std::system_error(errno, std::generic_category(), file.string() + ": " + what);
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : file_(file), descriptor_(::open(file.c_str(), flags | O_CLOEXEC, 0644)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  // A folder, a FIFO or a device in the place of a file would hold up or take what is read and written.
  const Descriptor& of_a_file() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) fail(file_, "cannot be looked at");
    if (S_ISREG(status.st_mode)) return *this;
    throw NoParameterFile(file_.string() + ": found something that is no file; expected a file");
  }
  bool is_open() const { return descriptor_ >= 0; }
  const Descriptor& or_fail(const char* what) const {
    if (!is_open()) fail(file_, what);
    return *this;
  }
  std::size_t read(char* to, std::size_t size) const {
    while (true) {
      const ssize_t got = ::read(descriptor_, to, size);
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno != EINTR) fail(file_, "cannot be read");
    }
  }
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) fail(file_, "cannot be written");
      if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  void sync() const {
    if (::fsync(descriptor_) != 0) fail(file_, "cannot be brought to the disk");
  }

 private:
  std::filesystem::path file_;
  int descriptor_;
};

class SystemFiles : public FileOperations {
  static constexpr std::size_t longest_read = 1 << 20;
  // A symbolic link in the place of a file leads to a file of a different owner; a FIFO has no reader or writer.
  static constexpr int own = O_NOFOLLOW | O_NONBLOCK;

 public:
  std::optional<std::string> read(const std::filesystem::path& file) override {
    const Descriptor descriptor(file, O_RDONLY | own);
    if (!descriptor.is_open() && errno == ENOENT) return {};
    descriptor.or_fail("cannot be opened").of_a_file();
    std::string bytes;
    std::array<char, 4096> block;
    // One more than is read back by anybody, so that its reader says what is wrong with it.
    while (bytes.size() <= longest_read) {
      const std::size_t got = descriptor.read(block.data(), block.size());
      if (got == 0) break;
      bytes.append(block.data(), got);
    }
    return bytes;
  }
  void create(const std::filesystem::path& file) override {
    Descriptor(file, O_WRONLY | O_CREAT | O_TRUNC | own).or_fail("cannot be created").of_a_file();
  }
  void append(const std::filesystem::path& file, std::string_view bytes) override {
    Descriptor(file, O_WRONLY | O_APPEND | own).or_fail("cannot be written").write(bytes);
  }
  void sync(const std::filesystem::path& file) override {
    Descriptor(file, O_WRONLY | own).or_fail("cannot be brought to the disk").sync();
  }
  void sync_folder(const std::filesystem::path& folder) override {
    Descriptor(folder, O_RDONLY | O_DIRECTORY).or_fail("cannot be brought to the disk").sync();
  }
  void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    if (::rename(from.c_str(), to.c_str()) != 0) fail(to, "cannot be replaced");
  }
  void link(const std::filesystem::path& file, const std::filesystem::path& name) override {
    if (::link(file.c_str(), name.c_str()) != 0) fail(name, "cannot be created");
  }
  void remove(const std::filesystem::path& file) override {
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) fail(file, "cannot be removed");
  }
};

}  // namespace

FileOperations& system_files() {
  static SystemFiles files;
  return files;
}

}  // namespace stiction::drive
