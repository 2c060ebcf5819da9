#include "hal/signals.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string_view>

#include "hal/power_cut.hpp"

namespace stiction::hal {
namespace {

std::atomic<void (*)(int) noexcept> words_at_the_end{nullptr};

void want_stop(int) { stop_wanted = 1; }
void note_asked(int signal) { signal_asked = signal; }

// The default is in force again and the signal comes once more, so that the process ends by it, for whoever waits for
// it and for a core dump.
void end_by(int signal) {
  power_cut.cut();
  if (const auto words = words_at_the_end.load(); words != nullptr) words(signal);
  say_if_heard("the power is off: the programme ends by ", 0);
  say_if_heard(name_of_signal(signal), 0);
  say_if_heard("\n", 0);
  ::raise(signal);
}

// Before what the library says of it, which may wait for a standard error without a reader.
[[noreturn]] void end_by_exception() {
  power_cut.cut();
  if (const auto error = std::current_exception()) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& caught) {
      say_if_heard("error: an uncaught exception: ", 0);
      say_if_heard(caught.what(), 0);
      say_if_heard("\n", 0);
    } catch (...) {
      say_if_heard("error: an uncaught exception\n", 0);
    }
  }
  std::abort();
}

void react(int number, SignalReaction reaction) {
  struct sigaction action {};
  switch (reaction) {
    case SignalReaction::stop:
      action.sa_handler = want_stop;
      break;
    case SignalReaction::ignore:
      action.sa_handler = SIG_IGN;
      break;
    case SignalReaction::ask:
      action.sa_handler = note_asked;
      break;
    case SignalReaction::cut:
      action.sa_handler = end_by;
      // On a stack of its own where the thread has one; the next one ends the process at once.
      action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER | SA_ONSTACK);
      break;
  }
  ::sigaction(number, &action, nullptr);
}

}  // namespace

const char* name_of_signal(int signal) noexcept {
  for (const SignalRow& row : signal_table)
    if (row.number == signal) return row.name;
  return "a signal";
}

void install_signal_reactions(void (*last_words)(int signal) noexcept) {
  words_at_the_end = last_words;
  static std::array<char, 16384> stack;  // for a signal of the calling thread whose own stack is used up
  stack_t alternate{};
  alternate.ss_sp = stack.data();
  alternate.ss_size = stack.size();
  ::sigaltstack(&alternate, nullptr);
  for (const SignalRow& row : signal_table) react(row.number, row.reaction);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) react(number, SignalReaction::ignore);
  std::set_terminate(end_by_exception);
}

void say_if_heard(const char* text, int patience_ms) noexcept {
  constexpr std::size_t most = 4096;  // PIPE_BUF: where poll() finds room there is as much
  pollfd writable{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&writable, 1, patience_ms) != 1 || (writable.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::min(std::strlen(text), most));
}

void keep_standard_descriptors() noexcept {
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    const int nowhere = ::open("/dev/null", O_RDWR);  // takes the lowest free one, which is this
    if (nowhere > STDERR_FILENO) ::close(nowhere);
  }
}

}  // namespace stiction::hal
