#include "tests/support/loop_cost.hpp"

#include <sys/ptrace.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

#ifndef STICTION_SANITIZED
// The C library's names, and the parameters' that its headers do not give.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming,readability-inconsistent-declaration-parameter-name)
extern "C" {
// Its own functions, behind the names that this program takes.
void* __libc_malloc(std::size_t size);
void __libc_free(void* block);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++stiction::test::allocator_calls;
  return __libc_malloc(size);
}
void free(void* block) noexcept {
  ++stiction::test::allocator_calls;
  __libc_free(block);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++stiction::test::allocator_calls;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  ++stiction::test::allocator_calls;
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++stiction::test::allocator_calls;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming,readability-inconsistent-declaration-parameter-name)
#endif

namespace stiction::test {
namespace {

// Marks the ends of what is counted: a call that the work has no reason to make, with an argument of ours.
constexpr long mark_call = SYS_getsid;
constexpr long mark_argument = 0x5717;

void mark() { ::syscall(mark_call, mark_argument); }

[[noreturn]] void run_child(const std::function<std::function<void()>()>& prepare) {
  if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(3);
  ::raise(SIGSTOP);
  const auto work = prepare();
  mark();
  work();
  mark();
  ::_exit(0);
}

// Number and first argument of the call that the stopped child is entering; false: it stopped at the return of one.
bool entering(pid_t child, long& number, long& argument) {
  __ptrace_syscall_info info{};
  if (::ptrace(PTRACE_GET_SYSCALL_INFO, child, sizeof info, &info) <= 0)
    throw std::runtime_error("PTRACE_GET_SYSCALL_INFO is not permitted");
  if (info.op != PTRACE_SYSCALL_INFO_ENTRY) return false;
  number = static_cast<long>(info.entry.nr);
  argument = static_cast<long>(info.entry.args[0]);
  return true;
}

}  // namespace

std::map<long, std::uint64_t> system_calls(const std::function<std::function<void()>()>& prepare) {
  const pid_t child = ::fork();
  if (child == 0) run_child(prepare);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFSTOPPED(status)) throw std::runtime_error("tracing a child process is not permitted");
  ::ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  std::map<long, std::uint64_t> counts;
  int marks = 0;
  int signal = 0;
  for (;;) {
    ::ptrace(PTRACE_SYSCALL, child, nullptr, signal);
    ::waitpid(child, &status, 0);
    if (!WIFSTOPPED(status)) break;
    signal = WSTOPSIG(status) == (SIGTRAP | 0x80) ? 0 : WSTOPSIG(status);
    long number = 0;
    long argument = 0;
    if (signal != 0 || !entering(child, number, argument)) continue;
    if (number == mark_call && argument == mark_argument)
      ++marks;
    else if (marks == 1)
      ++counts[number];
  }
  if (marks != 2 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("the traced child did not come to its end");
  return counts;
}

}  // namespace stiction::test
