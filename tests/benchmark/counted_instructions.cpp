#include "tests/benchmark/counted_instructions.hpp"

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

namespace stiction::benchmark {
namespace {

// Waits for the next stop of the child; false where it has ended.
bool stopped(pid_t child, int& status) { return waitpid(child, &status, 0) == child && WIFSTOPPED(status); }

}  // namespace

std::optional<std::uint64_t> counted_instructions(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
    raise(SIGSTOP);
    work();
    raise(SIGUSR1);
    _exit(0);
  }
  int status = 0;
  if (!stopped(child, status)) return std::nullopt;
  std::uint64_t count = 0;
  while (ptrace(PTRACE_SINGLESTEP, child, nullptr, nullptr) == 0 && stopped(child, status)) {
    if (WSTOPSIG(status) != SIGTRAP) break;  // the end of the work
    ++count;
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return count;
}

}  // namespace stiction::benchmark
