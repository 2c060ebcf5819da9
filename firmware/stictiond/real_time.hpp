// Makes the process and its loop's thread fit for real time on Linux, step by step, and says of each step what was done
// or why it was refused and what to do. What and why: the kernel's documentation of PREEMPT_RT applications
// (wiki.linuxfoundation.org/realtime, "HOWTO build an RT-application").
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stiction::drive {

struct RealTimeRequest {
  int priority = 80;  // of SCHED_FIFO; 0: the loop stays an ordinary thread
  int cpu = -1;       // processor of the loop; -1: any
  std::size_t stack_bytes = 256 * 1024;
  std::size_t heap_bytes = 8 * 1024 * 1024;
  // Of every thread that is made later. With locked memory the kernel fills the whole of it when it makes the thread,
  // which takes 3 ms for 1 MiB and 16 ms for the usual 8 MiB.
  std::size_t thread_stack_bytes = 1024 * 1024;
};

enum class StepOutcome : std::uint8_t {
  done,
  refused,    // asked for and not had
  absent,     // this machine or kernel does not have it
  not_asked,  // by the request
};

struct RealTimeStep {
  std::string name;
  StepOutcome outcome = StepOutcome::done;
  std::string text;  // what was done; where refused, why and what to do
};

// One line a step.
std::string text_of(std::span<const RealTimeStep> steps);

// Whether something that was asked for was not had.
bool any_refused(std::span<const RealTimeStep> steps);

// Keeps what the process holds for real time (/dev/cpu_dma_latency) until it ends, and what became of each step.
class RealTime {
 public:
  // Does nothing yet. `request`: what the loop needs.
  explicit RealTime(const RealTimeRequest& request) : request_(request) {}
  ~RealTime();
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;
  RealTime(RealTime&&) = delete;
  RealTime& operator=(RealTime&&) = delete;

  // Of the whole process, before it starts threads: allocator, heap, stacks of threads to come, locked memory, latency
  // of the processor's sleep.
  void prepare_process();

  // Of the calling thread, which becomes the loop's: stack, processor, priority. Threads that it starts later are
  // ordinary ones again, but stay on its processor.
  void prepare_thread();

  // What was done so far, in its order.
  std::span<const RealTimeStep> steps() const { return steps_; }

 private:
  RealTimeStep hold_latency();

  RealTimeRequest request_;
  std::vector<RealTimeStep> steps_;
  int latency_ = -1;
};

}  // namespace stiction::drive
