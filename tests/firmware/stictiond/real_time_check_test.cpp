// The check reads a folder that the tests fill as /proc, /sys and /dev of one machine or another.
#include "firmware/stictiond/real_time_check.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace stiction::test {
namespace {

namespace fs = std::filesystem;
using drive::Verdict;

class Machine : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / fmt::format("stiction-check-{}", ::getpid());
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& content) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << content << '\n';
  }

  drive::RealTimeFinding finding(const std::string& what, int cpu = 3) const {
    const auto findings = drive::check_real_time(root_, cpu);
    const auto row = std::find_if(findings.begin(), findings.end(), [&](auto& f) { return f.what == what; });
    EXPECT_NE(row, findings.end()) << what;
    return *row;
  }

  fs::path root_;
};

TEST_F(Machine, IsGoodWhereItWasMadeForRealTime) {
  write("proc/version", "Linux version 6.1.0-rt PREEMPT_RT");
  write("sys/kernel/realtime", "1");
  write("proc/cpuinfo", "flags\t: fpu tsc");
  write("sys/devices/system/cpu/isolated", "2-3");
  write("sys/devices/system/cpu/nohz_full", "1,3");
  write("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance");
  write("sys/devices/system/cpu/cpu3/cpuidle/state0/latency", "0");
  write("sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "170");
  write("sys/devices/system/cpu/cpu3/cpuidle/state1/disable", "1");
  write("dev/cpu_dma_latency", "");
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
  write("proc/sys/kernel/sched_rt_runtime_us", "950000");
  write("proc/sys/kernel/sched_rt_period_us", "1000000");
  for (const auto& f : drive::check_real_time(root_, 3)) {
    if (f.what == "rtprio" || f.what == "memlock") continue;  // of the process that tests
    EXPECT_EQ(f.verdict, Verdict::good) << f.what << ": " << f.found;
  }
}

TEST_F(Machine, IsToldWhatToDoWhereItWasNot) {
  write("proc/version", "Linux version 6.1.0-amd64 PREEMPT_DYNAMIC");
  write("proc/cpuinfo", "flags\t: fpu hypervisor lahf_lm");
  write("sys/devices/system/cpu/isolated", "");
  write("sys/devices/system/cpu/nohz_full", "(null)");
  write("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "powersave");
  write("sys/devices/system/cpu/cpu3/cpuidle/state1/latency", "170");
  write("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  for (const char* what : {"kernel", "machine", "isolcpus", "nohz_full", "governor", "sleep states", "clock"}) {
    const auto f = finding(what);
    EXPECT_EQ(f.verdict, Verdict::poor) << what;
    EXPECT_FALSE(f.advice.empty()) << what;
  }
  EXPECT_EQ(finding("isolcpus").advice, "boot with isolcpus=3");
  EXPECT_EQ(finding("isolcpus", -1).verdict, Verdict::poor);
}

TEST_F(Machine, DoesNotClaimWhatCannotBeSeen) {
  for (const char* what : {"governor", "sleep states", "cpu latency", "clock", "throttling"})
    EXPECT_EQ(finding(what).verdict, Verdict::unknown) << what;
}

// The figures depend on the machine's load; that each tick is counted does not.
TEST(Jitter, IsMeasuredOverEveryTickAndShownWithItsLongest) {
  const auto measured = drive::measure_jitter(1'000'000, 50, {.priority = 0, .heap_bytes = 4096});
  EXPECT_EQ(measured.lateness.total + measured.jumps, 50u);
  const auto text = drive::text_of(measured, 1'000'000);
  EXPECT_NE(text.find("50 ticks of 1000.0 us"), std::string::npos) << text;
  EXPECT_NE(text.find("below"), std::string::npos) << text;
}

}  // namespace
}  // namespace stiction::test
