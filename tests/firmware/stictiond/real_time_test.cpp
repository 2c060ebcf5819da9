// Each attempt runs in a child process: what it changes of scheduling and memory ends with it.
#include "firmware/stictiond/real_time.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <string>

#include "tests/support/sanitizer.hpp"

namespace stiction::test {
namespace {

long locked_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;)
    if (long kilobytes = 0; key == "VmLck:" && status >> kilobytes) return kilobytes;
  return 0;
}

// What `steps` says, made in a child: as nobody, without any right to real time, where `unprivileged`.
std::string steps_in_child(const drive::RealTimeRequest& request, bool unprivileged) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (unprivileged) {
      const rlimit none{};
      ::setrlimit(RLIMIT_RTPRIO, &none);
      ::setrlimit(RLIMIT_MEMLOCK, &none);
      if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
    }
    drive::RealTime real_time(request);
    real_time.prepare_process();
    real_time.prepare_thread();
    const auto steps = real_time.steps();
    std::string text = drive::text_of(steps);
    // What the kernel says of it.
    text += (::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) == SCHED_FIFO ? "is SCHED_FIFO\n" : "is ordinary\n";
    text += locked_kilobytes() > 0 ? "is locked\n" : "is not locked\n";
    text += drive::any_refused(steps) ? "refused\n" : "fit\n";
    const auto written = ::write(ends[1], text.data(), text.size());
    ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 3);
  }
  ::close(ends[1]);
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t n; (n = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << text;
  return text;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(RealTime, SaysWhatToDoForEachStepThatIsRefused) {
  if (address_sanitizer) GTEST_SKIP() << "the sanitizer locks no memory and says that it did";
  const auto text = steps_in_child({.priority = 80, .cpu = 1023}, true);
  EXPECT_TRUE(has(text, "heap         done")) << text;
  EXPECT_TRUE(has(text, "stack        done")) << text;
  EXPECT_TRUE(has(text, "threads      done      1024 KiB")) << text;
  EXPECT_TRUE(has(text, "priority     refused   Operation not permitted")) << text;
  EXPECT_TRUE(has(text, "LimitRTPRIO=80")) << text;
  EXPECT_TRUE(has(text, "memory lock  refused")) << text;
  EXPECT_TRUE(has(text, "LimitMEMLOCK=infinity")) << text;
  EXPECT_TRUE(has(text, "processor    refused   Invalid argument; processor 1023")) << text;
  EXPECT_TRUE(text.ends_with("refused\n")) << text;
}

TEST(RealTime, LeavesOutWhatWasNotAskedFor) {
  const auto text = steps_in_child({.priority = 0, .cpu = -1}, false);
  EXPECT_TRUE(has(text, "processor    not asked")) << text;
  EXPECT_TRUE(has(text, "priority     not asked")) << text;
  EXPECT_TRUE(has(text, "timer slack  done")) << text;
}

// Whether this process may have it depends on the machine; that what is called done is done does not.
TEST(RealTime, IsDoneWhereItSaysSo) {
  if (address_sanitizer) GTEST_SKIP() << "the sanitizer locks no memory and says that it did";
  const auto text = steps_in_child({.priority = 10, .cpu = 0}, false);
  EXPECT_EQ(has(text, "priority     done      SCHED_FIFO 10"), has(text, "is SCHED_FIFO")) << text;
  EXPECT_EQ(has(text, "memory lock  done"), has(text, "is locked")) << text;
  EXPECT_EQ(has(text, "refused  "), text.ends_with("refused\n")) << text;
}

}  // namespace
}  // namespace stiction::test
