#include "firmware/stictiond/log_output.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

namespace stiction::drive {
namespace {

const char* word_of(LogLevel level) {
  switch (level) {
    case LogLevel::error:
      return "error: ";
    case LogLevel::warning:
      return "warning: ";
    case LogLevel::notice:
    case LogLevel::info:
      break;
  }
  return "";
}

// False: the descriptor takes nothing (closed, its reader gone, its device full).
bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

struct LogOutput::Shared {
  int descriptor;
  bool journal;
  std::mutex mutex;  // never held over a write
  std::condition_variable wake, written;
  std::deque<std::string> lines;
  std::uint64_t lost = 0;
  bool end = false, ended = false;

  std::string line_of(LogLevel level, std::string_view text) const {
    text = text.substr(0, longest_line);
    if (text.ends_with('\n')) text.remove_suffix(1);
    return journal ? fmt::format("<{}>{}\n", static_cast<int>(level), text)
                   : fmt::format("stictiond: {}{}\n", word_of(level), text);
  }

  void run() {
    const sched_param ordinary{};
    ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
    std::uint64_t said = 0;
    std::unique_lock lock(mutex);
    while (true) {
      wake.wait(lock, [&] { return end || !lines.empty(); });
      if (lines.empty()) break;
      std::string line = std::move(lines.front());
      lines.pop_front();
      const std::uint64_t lost_before = lost;
      lock.unlock();
      if (lost_before != said)
        line = line_of(LogLevel::warning,
                       fmt::format("{} lines of the log were lost because standard error did not take them",
                                   lost_before - said)) +
               line;
      const bool taken = write_all(descriptor, line);
      lock.lock();
      if (taken)
        said = lost_before;
      else
        ++lost;
    }
    ended = true;
    written.notify_all();
  }
};

LogOutput::LogOutput(int descriptor, bool journal) : shared_(std::make_shared<Shared>()) {
  shared_->descriptor = descriptor;
  shared_->journal = journal;
  thread_ = std::thread([shared = shared_] { shared->run(); });
}

LogOutput::~LogOutput() {
  std::unique_lock lock(shared_->mutex);
  shared_->end = true;
  shared_->wake.notify_all();
  const bool ended =
      shared_->written.wait_for(lock, std::chrono::milliseconds(patience_ms), [this] { return shared_->ended; });
  lock.unlock();
  if (ended)
    thread_.join();
  else
    thread_.detach();  // its write never ends; what it uses is its own
}

void LogOutput::put(LogLevel level, std::string_view text) noexcept {
  try {
    std::string line = shared_->line_of(level, text);
    const std::lock_guard lock(shared_->mutex);
    if (shared_->lines.size() < capacity)
      shared_->lines.push_back(std::move(line));
    else
      ++shared_->lost;
  } catch (...) {  // no memory for a line: it is lost as one without room is
    const std::lock_guard lock(shared_->mutex);
    ++shared_->lost;
    return;
  }
  shared_->wake.notify_one();
}

std::uint64_t LogOutput::lost() const noexcept {
  const std::lock_guard lock(shared_->mutex);
  return shared_->lost;
}

bool journal_listens() { return std::getenv("JOURNAL_STREAM") != nullptr; }

}  // namespace stiction::drive
