#include "firmware/stictiond/trace_room.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "firmware/stictiond/configuration.hpp"

namespace stiction::drive {
namespace {

constexpr double mega = 1e6;

// Of the whole computer. A service that sees processes alone of /proc (ProcSubset=pid) is told less by the kernel: what
// is free without giving up any file that is kept in memory.
double free_memory() {
  std::ifstream table("/proc/meminfo");
  std::string key, unit;
  double kibibytes = 0.0;
  while (table >> key >> kibibytes && std::getline(table, unit))
    if (key == "MemAvailable:") return kibibytes * 1024.0;
  struct sysinfo memory {};
  if (::sysinfo(&memory) == 0)
    return static_cast<double>(memory.freeram + memory.bufferram) * static_cast<double>(memory.mem_unit);
  return std::numeric_limits<double>::infinity();
}

double lockable_memory() {
  rlimit limit{};
  if (::geteuid() == 0 || ::getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur);
}

}  // namespace

void check_memory(double bytes, bool locked) {
  constexpr double share = 0.8;  // the rest of the computer needs some too
  const double most = std::min(share * free_memory(), locked ? lockable_memory() : free_memory());
  if (bytes > most)
    throw StartRefused(
        fmt::format("the motion and its trace: found a need of {:.0f} MB of memory; expected at most {:.0f} MB, which "
                    "are free and may be locked: choose a faster feed, or no --trace",
                    bytes / mega, most / mega));
}

void check_trace_file(const std::filesystem::path& file, std::uint64_t bytes) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (descriptor < 0)
    throw StartRefused(
        fmt::format("--trace: {}: {}; expected a file that can be written", file.string(), std::strerror(errno)));
  struct stat status {};
  const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const int error = regular ? ::posix_fallocate(descriptor, 0, std::max<off_t>(static_cast<off_t>(bytes), 1)) : 0;
  const bool emptied = !regular || ::ftruncate(descriptor, 0) == 0;
  ::close(descriptor);
  if (!regular)
    throw StartRefused(fmt::format("--trace: {}: found a device or a pipe; expected an ordinary file", file.string()));
  // A file system that reserves nothing answers with one of the last two.
  if ((error != 0 && error != EOPNOTSUPP && error != EINVAL) || !emptied)
    throw StartRefused(fmt::format("--trace: {}: {}; expected room for {:.0f} MB", file.string(), std::strerror(error),
                                   static_cast<double>(bytes) / mega));
}

}  // namespace stiction::drive
