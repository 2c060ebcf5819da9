#include "firmware/stictiond/real_time_check.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <thread>

#include "hal/tick_clock.hpp"

namespace stiction::drive {
namespace {

namespace fs = std::filesystem;

// The first line of a file of the kernel; none where it cannot be read.
std::optional<std::string> line_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) return std::nullopt;
  return line;
}

std::optional<long long> number_of(const fs::path& file) {
  const auto line = line_of(file);
  long long number = 0;
  if (!line || std::from_chars(line->data(), line->data() + line->size(), number).ec != std::errc{})
    return std::nullopt;
  return number;
}

// Whether a list of the kernel, "2-3,6", names this processor.
bool names(const std::string& list, int cpu) {
  const char* at = list.data();
  const char* const end = at + list.size();
  while (at < end) {
    int first = 0;
    auto next = std::from_chars(at, end, first);
    if (next.ec != std::errc{}) return false;
    int last = first;
    if (next.ptr < end && *next.ptr == '-') next = std::from_chars(next.ptr + 1, end, last);
    if (cpu >= first && cpu <= last) return true;
    at = next.ptr + 1;
  }
  return false;
}

RealTimeFinding kernel(const fs::path& root) {
  const std::string version = line_of(root / "proc/version").value_or("unknown");
  const bool full = line_of(root / "sys/kernel/realtime") == "1" || version.find("PREEMPT_RT") != std::string::npos;
  if (full) return {"kernel", Verdict::good, "PREEMPT_RT", ""};
  return {"kernel", Verdict::poor, "without PREEMPT_RT: a driver can delay the loop by milliseconds",
          "install linux-image-rt-amd64 and boot it"};
}

RealTimeFinding machine(const fs::path& root) {
  std::ifstream stream(root / "proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("flags") && line.find(" hypervisor") != std::string::npos)
      return {"machine", Verdict::poor, "virtual: the host can interrupt it at any time",
              "run the drive on a physical computer"};
  return {"machine", Verdict::good, "no hypervisor detected", ""};
}

RealTimeFinding isolation(const fs::path& root, int cpu, const char* what, const char* file) {
  const std::string list = line_of(root / "sys/devices/system/cpu" / file).value_or("");
  if (cpu >= 0 && names(list, cpu)) return {what, Verdict::good, fmt::format("processor {} is in {}", cpu, list), ""};
  const std::string found = list.empty() || list == "(null)" ? "none" : list;
  if (cpu < 0)
    return {what, Verdict::poor, fmt::format("{}; no processor is reserved for the loop", found),
            "reserve one in the machine file, [drive.real_time] cpu, and boot with isolcpus=N nohz_full=N rcu_nocbs=N"};
  return {what, Verdict::poor, fmt::format("{}; processor {} is not in it", found, cpu),
          fmt::format("boot with {}={}", what, cpu)};
}

RealTimeFinding governor(const fs::path& root, int cpu) {
  const auto file = root / fmt::format("sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", std::max(cpu, 0));
  const auto found = line_of(file);
  if (!found) return {"governor", Verdict::unknown, "no frequency scaling found", ""};
  if (*found == "performance") return {"governor", Verdict::good, *found, ""};
  return {"governor", Verdict::poor, *found, "cpupower frequency-set -g performance (package linux-cpupower)"};
}

// Longest time that an enabled sleep state needs to wake from, us.
RealTimeFinding sleep_states(const fs::path& root, int cpu) {
  constexpr long long fine = 10;
  const auto folder = root / fmt::format("sys/devices/system/cpu/cpu{}/cpuidle", std::max(cpu, 0));
  std::error_code error;
  std::optional<long long> longest;
  for (const auto& state : fs::directory_iterator(folder, error)) {
    if (number_of(state.path() / "disable").value_or(0) != 0) continue;
    if (const auto latency = number_of(state.path() / "latency")) longest = std::max(longest.value_or(0), *latency);
  }
  if (!longest) return {"sleep states", Verdict::unknown, "none found", ""};
  if (*longest <= fine)
    return {"sleep states", Verdict::good, fmt::format("the deepest wakes within {} us", *longest), ""};
  return {"sleep states", Verdict::poor, fmt::format("the deepest wakes after {} us", *longest),
          "the drive holds /dev/cpu_dma_latency at 0; without that boot with processor.max_cstate=1 idle=poll"};
}

RealTimeFinding latency_device(const fs::path& root) {
  const auto device = root / "dev/cpu_dma_latency";
  std::error_code error;
  if (!fs::exists(device, error)) return {"cpu latency", Verdict::unknown, "/dev/cpu_dma_latency does not exist", ""};
  if (::access(device.c_str(), W_OK) == 0)
    return {"cpu latency", Verdict::good, "/dev/cpu_dma_latency is writable", ""};
  return {"cpu latency", Verdict::poor, "/dev/cpu_dma_latency is not writable",
          "run as the user of the drive, or as a member of the group in the udev rule of the package"};
}

RealTimeFinding clock_source(const fs::path& root) {
  const auto found = line_of(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  if (!found) return {"clock", Verdict::unknown, "not found", ""};
  // Read without a system call on x86-64 and on Arm.
  if (*found == "tsc" || *found == "kvm-clock" || *found == "arch_sys_counter")
    return {"clock", Verdict::good, *found, ""};
  return {"clock", Verdict::poor, *found + ": every reading is a system call", "boot with tsc=reliable if it is"};
}

RealTimeFinding throttling(const fs::path& root) {
  const auto runtime = number_of(root / "proc/sys/kernel/sched_rt_runtime_us");
  const auto period = number_of(root / "proc/sys/kernel/sched_rt_period_us");
  if (!runtime || !period) return {"throttling", Verdict::unknown, "not found", ""};
  if (*runtime < 0) return {"throttling", Verdict::good, "off", ""};
  // A loop of 62.5 us works a few of them: far from the share at which the kernel stops it.
  return {"throttling", Verdict::good, fmt::format("after {} us of {}, more than the loop takes", *runtime, *period),
          ""};
}

RealTimeFinding limit(const char* what, int resource, rlim_t wanted, const char* advice) {
  rlimit found{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &found);
  const std::string text = found.rlim_cur == RLIM_INFINITY ? "unlimited" : fmt::format("{}", found.rlim_cur);
  if (found.rlim_cur >= wanted || ::geteuid() == 0) return {what, Verdict::good, ::geteuid() == 0 ? "root" : text, ""};
  return {what, Verdict::poor, text, advice};
}

const char* word_of(Verdict verdict) {
  constexpr std::array words{"good", "poor", "?"};
  return words[static_cast<std::size_t>(verdict)];
}

double us(std::int64_t time_ns) { return static_cast<double>(time_ns) * 1e-3; }

}  // namespace

std::vector<RealTimeFinding> check_real_time(const fs::path& root, int cpu) {
  return {kernel(root),
          machine(root),
          isolation(root, cpu, "isolcpus", "isolated"),
          isolation(root, cpu, "nohz_full", "nohz_full"),
          governor(root, cpu),
          sleep_states(root, cpu),
          latency_device(root),
          clock_source(root),
          throttling(root),
          limit("rtprio", RLIMIT_RTPRIO, 1, "LimitRTPRIO= in the unit, or \"rtprio 98\" in /etc/security/limits.d"),
          limit("memlock", RLIMIT_MEMLOCK, RLIM_INFINITY,
                "LimitMEMLOCK=infinity in the unit, or \"memlock unlimited\" in /etc/security/limits.d")};
}

std::string text_of(std::span<const RealTimeFinding> findings) {
  std::string text;
  for (const RealTimeFinding& finding : findings) {
    text += fmt::format("{:<13} {:<5} {}\n", finding.what, word_of(finding.verdict), finding.found);
    if (!finding.advice.empty()) text += fmt::format("{:<13} {:<5} -> {}\n", "", "", finding.advice);
  }
  return text;
}

JitterMeasurement measure_jitter(std::int64_t period_ns, std::uint64_t ticks, const RealTimeRequest& request) {
  JitterMeasurement result;
  std::thread([&] {
    RealTime real_time(request);
    real_time.prepare_process();
    real_time.prepare_thread();
    result.steps.assign(real_time.steps().begin(), real_time.steps().end());
    hal::TickClock clock(period_ns);
    for (std::uint64_t i = 0; i < ticks; ++i) clock.wait();
    result.lateness = clock.lateness().read();
    result.missed = clock.missed();
    result.jumps = clock.jumps();
  }).join();
  return result;
}

std::string text_of(const JitterMeasurement& measurement, std::int64_t period_ns) {
  const hal::TimeCounts& late = measurement.lateness;
  std::string text = text_of(measurement.steps);
  text += fmt::format(
      "{} ticks of {:.1f} us began late by: mean {:.1f}, median {:.1f}, 99 % {:.1f}, 99.9 % {:.1f}, largest {:.1f} us; "
      "{} missed, {} clock jumps\n",
      late.total, us(period_ns), late.mean * 1e-3, us(late.quantile(0.5)), us(late.quantile(0.99)),
      us(late.quantile(0.999)), us(late.maximum), measurement.missed, measurement.jumps);
  constexpr double width = 50.0;
  for (std::int64_t end = 1024; late.total > 0; end *= 2) {
    std::uint64_t count = 0;
    for (std::size_t bin = 0; bin < late.counts.size(); ++bin)
      if (const auto begin = hal::time_bins::begin_of(bin); begin < end && (begin >= end / 2 || end == 1024))
        count += late.counts[bin];
    // By the logarithm: a single late tick among millions is what one looks for.
    const double share = std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(late.total));
    text += fmt::format("below {:>9.1f} us {:>10} {}\n", us(end), count,
                        std::string(static_cast<std::size_t>(std::lround(width * share)), '#'));
    if (end > late.maximum) break;
  }
  return text + "Judge by a histogram over a whole day under the real load of the machine.\n";
}

}  // namespace stiction::drive
