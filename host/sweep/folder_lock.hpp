// Locks on numbered places of one file, by which threads, processes and nodes of a cluster share out the chunks of a
// sweep. The kernel gives a lock back when its holder ends, however it ends, so that nothing has to be cleaned up after
// a process that was killed: open file description locks (fcntl(2), F_OFD_SETLK), which NFS serves too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace stiction::host {

class FolderLock {
 public:
  // The lock `place` (0 ..) of `file`, which is made where there is none: none where another one holds it. Throws
  // std::runtime_error when the file system refuses.
  static std::optional<FolderLock> attempt(const std::filesystem::path& file, std::uint64_t place);
  // The same, after waiting for it.
  static FolderLock wait(const std::filesystem::path& file, std::uint64_t place);

  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace stiction::host
