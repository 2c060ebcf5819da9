#include "host/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace stiction::host {

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)), total_(total), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::add(std::string_view now) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (!terminal_ || std::chrono::steady_clock::now() - begin_ < std::chrono::seconds(1)) return;
  constexpr std::size_t width = 30;
  const std::size_t filled = width * done_ / total_;
  fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {} of {}  {}", what_, "", filled, "", width - filled, done_, total_,
             now);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace stiction::host
