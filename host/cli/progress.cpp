#include "host/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace stiction::host {

Progress::Progress(std::string what, std::size_t total, bool shown) : what_(std::move(what)), total_(total) {
  if (shown && ::isatty(STDERR_FILENO) == 1) thread_ = std::thread([this] { draw_until_done(); });
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

void Progress::reach(std::size_t done) {
  const std::lock_guard lock(mutex_);
  const auto present = std::chrono::steady_clock::now();
  if (!first_reached_) first_reached_ = {done, present};
  done_ = std::max(done_, done);
  const auto [before, begin] = *first_reached_;
  if (done_ <= before) return;
  const double each = std::chrono::duration<double>(present - begin).count() / static_cast<double>(done_ - before);
  const double left = each * static_cast<double>(total_ - std::min(done_, total_));
  now_ = left < 120.0 ? fmt::format("about {:.0f} s left", left) : fmt::format("about {:.0f} min left", left / 60.0);
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
