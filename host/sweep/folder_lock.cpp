#include "host/sweep/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <utility>

#include "firmware/machine/file/whole_file.hpp"

namespace stiction::host {
namespace {

[[noreturn]] void fail_to_lock(const std::filesystem::path& file, int error) {
  throw std::runtime_error(fmt::format("{}: cannot be locked: {}", file.string(), machine::file_error_words(error)));
}

int open_lock_file(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail_to_lock(file, errno);
  return descriptor;
}

struct flock one_byte(std::uint64_t place) {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = static_cast<off_t>(place);
  lock.l_len = 1;
  return lock;
}

}  // namespace

std::optional<FolderLock> FolderLock::attempt(const std::filesystem::path& file, std::uint64_t place) {
  FolderLock held(open_lock_file(file));
  auto lock = one_byte(place);
  if (::fcntl(held.descriptor_, F_OFD_SETLK, &lock) == 0) return held;
  if (errno != EAGAIN && errno != EACCES) fail_to_lock(file, errno);
  return std::nullopt;
}

FolderLock FolderLock::wait(const std::filesystem::path& file, std::uint64_t place) {
  FolderLock held(open_lock_file(file));
  auto lock = one_byte(place);
  while (::fcntl(held.descriptor_, F_OFD_SETLKW, &lock) != 0)
    if (errno != EINTR) fail_to_lock(file, errno);
  return held;
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace stiction::host
