// What `stictiond --check-realtime` says: whether this machine is fit for a loop of so short a period, what speaks
// against it and what to do, and a first measurement. The recipe: kernel documentation (admin-guide/kernel-parameters,
// power/pm_qos_interface) and shared practice of LinuxCNC and IgH EtherCAT installations.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "firmware/stictiond/real_time.hpp"
#include "hal/time_histogram.hpp"

namespace stiction::drive {

enum class Verdict : std::uint8_t { good, poor, unknown };

struct RealTimeFinding {
  std::string what;
  Verdict verdict = Verdict::unknown;
  std::string found;
  std::string advice;  // empty where it is good
};

// Reads the machine's settings below `root` (of /proc, /sys and /dev; tests put another folder there) and the process'
// own limits. `cpu`: the loop's processor, -1: any.
std::vector<RealTimeFinding> check_real_time(const std::filesystem::path& root, int cpu);

// One line a finding, with its advice below.
std::string text_of(std::span<const RealTimeFinding> findings);

struct JitterMeasurement {
  std::vector<RealTimeStep> steps;  // how the measuring thread was prepared
  hal::TimeCounts lateness;
  std::uint64_t missed = 0;
  std::uint64_t jumps = 0;
};

// Sleeps through so many ticks in a thread of its own, prepared as the loop's would be. `period_ns`: from one tick to
// the next, above 0; `ticks`: their number; `request`: priority, processor and memory as for the loop.
JitterMeasurement measure_jitter(std::int64_t period_ns, std::uint64_t ticks, const RealTimeRequest& request);

// Median to maximum, and a bar for each octave of lateness.
std::string text_of(const JitterMeasurement& measurement, std::int64_t period_ns);

}  // namespace stiction::drive
