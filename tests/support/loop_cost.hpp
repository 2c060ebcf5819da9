// What a piece of code asks of the allocator and of the kernel: allocations, page faults, system calls, counted. For
// tests that are programs of their own, because including this replaces malloc.
#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include "tests/support/sanitizer.hpp"

// A sanitizer has an allocator and calls of its own: nothing is replaced then, and the counts mean nothing.
#if STICTION_ADDRESS_SANITIZER || defined(__SANITIZE_THREAD__)
#define STICTION_SANITIZED
#endif

namespace stiction::test {

inline thread_local std::uint64_t allocator_calls = 0;  // malloc, free and their kin, of this thread

struct MemoryCost {
  std::uint64_t allocator_calls = 0;
  long minor_faults = 0;
  long major_faults = 0;
};

// Of this thread, while `work` runs.
template <class Work>
MemoryCost memory_cost(Work&& work) {
  rusage before{};
  rusage after{};
  const std::uint64_t calls = allocator_calls;
  ::getrusage(RUSAGE_THREAD, &before);
  work();
  ::getrusage(RUSAGE_THREAD, &after);
  return {allocator_calls - calls, after.ru_minflt - before.ru_minflt, after.ru_majflt - before.ru_majflt};
}

// System calls by number while `work` runs; `prepare` runs before, uncounted. Both in a traced child process; throws
// std::runtime_error where tracing is not permitted or the child fails.
std::map<long, std::uint64_t> system_calls(const std::function<std::function<void()>()>& prepare);

}  // namespace stiction::test
