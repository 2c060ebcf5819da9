#include "firmware/stictiond/real_time.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace stiction::drive {
namespace {

constexpr const char* latency_device = "/dev/cpu_dma_latency";
constexpr std::size_t page_bytes = 4096;  // the smallest of any machine: a larger one is only touched more often

const char* word_of(StepOutcome outcome) {
  constexpr std::array words{"done", "refused", "absent", "not asked"};
  return words[static_cast<std::size_t>(outcome)];
}

RealTimeStep refused(const char* name, int error, const std::string& advice) {
  return {name, StepOutcome::refused, fmt::format("{}; {}", std::strerror(error), advice)};
}

// A heap that is never given back to the kernel and never mapped anew: what was touched once stays.
RealTimeStep keep_heap(std::size_t bytes) {
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_ARENA_MAX, 1);
  void* block = std::malloc(bytes);  // NOLINT(cppcoreguidelines-no-malloc): of the allocator that is being set up
  if (block == nullptr) return refused("heap", ENOMEM, "give the process more memory");
  auto* byte = static_cast<volatile char*>(block);
  for (std::size_t i = 0; i < bytes; i += page_bytes) byte[i] = 0;
  std::free(block);  // NOLINT(cppcoreguidelines-no-malloc)
  return {"heap", StepOutcome::done, fmt::format("{} KiB touched; never trimmed and never mapped again", bytes / 1024)};
}

// The C library's default for threads that are made without a size of their own, as std::thread does.
RealTimeStep bound_thread_stacks(std::size_t bytes) {
  constexpr const char* name = "threads";
  pthread_attr_t attributes;
  int error = ::pthread_getattr_default_np(&attributes);
  if (error == 0) error = ::pthread_attr_setstacksize(&attributes, bytes);
  if (error == 0) error = ::pthread_setattr_default_np(&attributes);
  if (error == 0) return {name, StepOutcome::done, fmt::format("{} KiB of stack for each to come", bytes / 1024)};
  return refused(name, error, fmt::format("the C library must allow threads with stacks of {} KiB", bytes / 1024));
}

RealTimeStep lock_memory() {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0)
    return {"memory lock", StepOutcome::done, "all present and future pages"};
  return refused("memory lock", errno,
                 "raise the limit: LimitMEMLOCK=infinity in the unit, or \"memlock unlimited\" in "
                 "/etc/security/limits.d");
}

// Frames of a fixed size, one inside the other: the stack really is used so far down, at its true place. The bytes are
// written after the call too, or the compiler would make a loop of it.
[[gnu::noinline]] void touch_stack(std::size_t bytes) {
  std::array<volatile char, page_bytes> frame;
  frame.front() = 0;
  if (bytes > page_bytes) touch_stack(bytes - page_bytes);
  frame.back() = 0;
}

RealTimeStep prefault_stack(std::size_t bytes) {
  touch_stack(bytes);
  return {"stack", StepOutcome::done, fmt::format("{} KiB touched", bytes / 1024)};
}

RealTimeStep bind_processor(int cpu) {
  constexpr const char* name = "processor";
  if (cpu < 0) return {name, StepOutcome::not_asked, "any; choose one with [drive.real_time] cpu"};
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  if (::sched_setaffinity(0, sizeof set, &set) == 0) return {name, StepOutcome::done, fmt::format("number {}", cpu)};
  return refused(name, errno,
                 fmt::format("processor {} is not one that this process may run on: see [drive.real_time] cpu in the "
                             "machine file and CPUAffinity= in the unit",
                             cpu));
}

// An ordinary thread's sleeps end up to 50 us late, so that the kernel can wake several at once.
RealTimeStep end_timer_slack() {
  if (::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0) return {"timer slack", StepOutcome::done, "1 ns"};
  return refused("timer slack", errno, "the kernel must have PR_SET_TIMERSLACK");
}

RealTimeStep raise_priority(int priority) {
  constexpr const char* name = "priority";
  if (priority <= 0) return {name, StepOutcome::not_asked, "an ordinary thread; see [drive.real_time] priority"};
  const sched_param parameter{priority};
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0)
    return {name, StepOutcome::done, fmt::format("SCHED_FIFO {}", priority)};
  return refused(name, errno,
                 fmt::format("allow it: LimitRTPRIO={0} in the unit, \"rtprio {0}\" in /etc/security/limits.d, or the "
                             "capability CAP_SYS_NICE; RestrictRealtime= must not be set",
                             priority));
}

}  // namespace

std::string text_of(std::span<const RealTimeStep> steps) {
  std::string text;
  for (const RealTimeStep& step : steps)
    text += fmt::format("{:<12} {:<9} {}\n", step.name, word_of(step.outcome), step.text);
  return text;
}

bool any_refused(std::span<const RealTimeStep> steps) {
  return std::any_of(steps.begin(), steps.end(),
                     [](const RealTimeStep& step) { return step.outcome == StepOutcome::refused; });
}

RealTime::~RealTime() {
  if (latency_ >= 0) ::close(latency_);
}

// The kernel keeps the processors out of deep sleep, from which they wake too late, as long as the file is open.
RealTimeStep RealTime::hold_latency() {
  constexpr const char* name = "cpu latency";
  if (latency_ < 0) latency_ = ::open(latency_device, O_WRONLY | O_CLOEXEC);
  if (latency_ < 0 && errno == ENOENT)
    return {name, StepOutcome::absent, fmt::format("{} is not there: a kernel without it", latency_device)};
  constexpr std::int32_t microseconds = 0;
  if (latency_ >= 0 && ::write(latency_, &microseconds, sizeof microseconds) == sizeof microseconds)
    return {name, StepOutcome::done, fmt::format("{} held at 0 us", latency_device)};
  return refused(name, errno, fmt::format("give the drive's group write access to {} by a udev rule", latency_device));
}

void RealTime::prepare_process() {
  steps_.push_back(keep_heap(request_.heap_bytes));
  steps_.push_back(bound_thread_stacks(request_.thread_stack_bytes));
  steps_.push_back(lock_memory());
  steps_.push_back(hold_latency());
}

void RealTime::prepare_thread() {
  steps_.push_back(prefault_stack(request_.stack_bytes));
  steps_.push_back(bind_processor(request_.cpu));
  steps_.push_back(end_timer_slack());
  steps_.push_back(raise_priority(request_.priority));
}

}  // namespace stiction::drive
