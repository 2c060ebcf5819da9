#include "firmware/stictiond/run_record.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "firmware/stictiond/configuration.hpp"
#include "hal/signals.hpp"

namespace stiction::drive {
namespace {

constexpr std::string_view running = "while running\n";
std::atomic<int> of_this_run{-1};  // the descriptor while a run is under way

void replace(int descriptor, std::string_view text) noexcept {
  if (::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size())) [[maybe_unused]]
    const int cut = ::ftruncate(descriptor, static_cast<off_t>(text.size()));
}

std::string text_in(int descriptor) {
  std::array<char, 64> bytes;
  const ssize_t got = ::pread(descriptor, bytes.data(), bytes.size(), 0);
  std::string text(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  text.erase(std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }), text.end());
  return text;
}

}  // namespace

RunRecord::RunRecord(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  const std::string file = (folder / "run").string();
  descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
  if (descriptor_ < 0)
    throw StartRefused(fmt::format("{}: {}; expected a folder of --parameters that the drive may write to", file,
                                   std::strerror(errno)));
  struct stat status {};
  const bool regular = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  const bool locked = regular && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  if (!locked) {
    ::close(descriptor_);
    throw StartRefused(
        regular
            ? fmt::format("{}: found a different drive that runs with this folder; expected one drive a folder", file)
            : fmt::format("{}: found something that is no file; expected a file", file));
  }
  if (const std::string text = text_in(descriptor_); !text.empty()) broken_off_ = text;
}

RunRecord::~RunRecord() {
  of_this_run = -1;
  if (descriptor_ >= 0) ::close(descriptor_);
}

void RunRecord::begin() {
  if (descriptor_ < 0) return;
  replace(descriptor_, running);
  of_this_run = descriptor_;
}

void RunRecord::end() {
  of_this_run = -1;
  if (descriptor_ >= 0) replace(descriptor_, {});
}

void RunRecord::note_signal(int signal) noexcept {
  const int descriptor = of_this_run;
  const char* name = hal::name_of_signal(signal);
  if (descriptor < 0) return;
  std::array<char, 32> text{'b', 'y', ' '};
  const std::size_t length = std::min(std::strlen(name), text.size() - 4);
  std::copy_n(name, length, text.begin() + 3);
  text[3 + length] = '\n';
  replace(descriptor, {text.data(), length + 4});
}

}  // namespace stiction::drive
