#include "host/cli/temporaries.hpp"

#include <pthread.h>

#include <csignal>
#include <cstdio>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

namespace stiction::host {
namespace {

struct Temporaries {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;
  std::string last_words;
};

// Never destroyed: an interruption may come while the programme ends.
Temporaries& temporaries() {
  static auto* const all = new Temporaries;
  return *all;
}

sigset_t interruptions() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, signal);
  return set;
}

// Removing a folder is nothing that a signal's handler may do; a thread that waits for the signal may.
void wait_for_interruption() {
  const auto set = interruptions();
  int signal = 0;
  if (sigwait(&set, &signal) != 0) return;
  const std::lock_guard lock(temporaries().mutex);
  std::error_code ignored;
  for (const auto& path : temporaries().paths) std::filesystem::remove_all(path, ignored);
  std::fputs(temporaries().last_words.c_str(), stderr);
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  std::raise(signal);
}

}  // namespace

void remove_temporaries_when_interrupted() {
  auto set = interruptions();
  // What the caller ignores, as nohup does with the closed terminal, stays ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now = {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) sigdelset(&set, signal);
  }
  if (pthread_sigmask(SIG_BLOCK, &set, nullptr) == 0) std::thread(wait_for_interruption).detach();
}

void register_temporary(const std::filesystem::path& path) {
  const std::lock_guard lock(temporaries().mutex);
  temporaries().paths.insert(std::filesystem::absolute(path));
}

void forget_temporary(const std::filesystem::path& path) {
  const std::lock_guard lock(temporaries().mutex);
  temporaries().paths.erase(std::filesystem::absolute(path));
}

void say_when_interrupted(std::string text) {
  const std::lock_guard lock(temporaries().mutex);
  temporaries().last_words = std::move(text);
}

void without_interruption(const std::function<void()>& step) {
  const std::lock_guard lock(temporaries().mutex);
  step();
}

}  // namespace stiction::host
