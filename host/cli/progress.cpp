#include "host/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace stiction::host {

Progress::Progress(std::string what, std::size_t total) : what_(std::move(what)), total_(total) {
  if (::isatty(STDERR_FILENO) == 1) thread_ = std::thread([this] { draw_until_done(); });
}

Progress::~Progress() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Progress::add(std::string_view now) {
  const std::lock_guard lock(mutex_);
  ++done_;
  now_ = now;
}

void Progress::draw_until_done() {
  std::unique_lock lock(mutex_);
  auto wait = std::chrono::milliseconds(1000);
  bool shown = false;
  while (!changed_.wait_for(lock, wait, [this] { return over_; })) {
    draw();
    shown = true;
    wait = std::chrono::milliseconds(200);
  }
  if (!shown) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

void Progress::draw() const {
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin_).count();
  constexpr std::size_t width = 30;
  if (total_ == 0) {
    fmt::print(stderr, "\r\x1b[K{}: {} s", what_, seconds);
  } else {
    const std::size_t filled = width * std::min(done_, total_) / total_;
    fmt::print(stderr, "\r\x1b[K{} [{:#<{}}{:.<{}}] {} of {}, {} s  {}", what_, "", filled, "", width - filled, done_,
               total_, seconds, now_);
  }
  std::fflush(stderr);
}

}  // namespace stiction::host
