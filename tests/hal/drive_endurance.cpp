// Drive time on the simulated machine with random faults, one a minute in the mean: circles of random feeds, something
// breaks, must be seen and stopped, is repaired, reset, and on it goes. Prints what was injected and what became of it,
// the memory and the time. Status 1: a fault was not seen, an alarm was false, a drive did not come back, or memory
// grew by more than 1 MB after the first minute.
//
// usage: drive_endurance [--minutes N] [--seed N]
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/hal/fault_cases.hpp"
#include "tests/support/shipped_machine.hpp"

namespace stiction::test {
namespace {

constexpr int second = 16000;  // ticks

struct Count {
  int injected = 0;
  int seen = 0;       // as the row that it belongs to
  int otherwise = 0;  // as another row, which came first
  int unseen = 0;
};

// Resident, in bytes.
double memory() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

class Endurance {
 public:
  Endurance(std::uint64_t seed, const machine::Machine& machine)
      : random_(seed), bench_(machine, drive_setup(machine), seed), marks_(memory()) {
    for (auto& c : fault_cases())
      if (c.machine.empty() && !c.setup) cases_.push_back(std::move(c));  // what needs no machine of its own
  }

  // True when all was as it must be.
  bool run(double minutes) {
    const auto ticks = static_cast<std::uint64_t>(minutes * 60.0 * second);
    while (bench_.ticks < ticks && broken_ == 0) {
      const auto& c = cases_[below(cases_.size())];
      move(c);
      break_down(c, below(2));
      if (bench_.ticks > 60 * second && marks_at_minute_ == 0.0) marks_at_minute_ = memory();
      bench_.events.clear();
    }
    return false_alarms_ == 0 && broken_ == 0 && still_powered_ == 0 && unseen() == 0 && !grew();
  }

  // A leak of 100 bytes a tick shows within a second of drive time, of 1 byte within a minute.
  bool grew() const { return marks_at_minute_ > 0.0 && memory() > marks_at_minute_ + 1e6; }

  void print(double wall) const {
    int injected = 0, seen = 0, otherwise = 0;
    fmt::print("{:<56}{:>9}{:>7}{:>11}{:>8}\n", "fault", "injected", "seen", "as another", "unseen");
    for (const auto& [name, count] : counts_) {
      fmt::print("{:<56}{:>9}{:>7}{:>11}{:>8}\n", name, count.injected, count.seen, count.otherwise, count.unseen);
      injected += count.injected;
      seen += count.seen;
      otherwise += count.otherwise;
    }
    fmt::print("{:<56}{:>9}{:>7}{:>11}{:>8}\n", "all", injected, seen, otherwise, unseen());
    const double hours = static_cast<double>(bench_.ticks) / second / 3600.0;
    fmt::print("false alarms {}, drives that did not come back {}, power on a second after a fault {}\n", false_alarms_,
               broken_, still_powered_);
    fmt::print(
        "drive time {:.3f} h in {:.0f} s, {:.0f} times as fast; memory {:.1f} MB at the start, {:.1f} MB after a "
        "minute, "
        "{:.1f} MB at the end\n",
        hours, wall, hours * 3600.0 / wall, marks_ * 1e-6, marks_at_minute_ * 1e-6, memory() * 1e-6);
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int unseen() const {
    int sum = 0;
    for (const auto& [name, count] : counts_) sum += count.unseen;
    return sum;
  }

  void move(const FaultCase& c) {
    if (!bench_.reset() || !bench_.enable()) {
      ++broken_;
      return;
    }
    const double angle = between(-3.14, 3.14);
    bench_.travel_to({0.09 * std::cos(angle), 0.09 * std::sin(angle)}, 3.0);
    bench_.run(4 * second);
    if (c.holding) return;
    bench_.move({.feed = std::max(between(3.2, 48.0) / 60.0, c.least_feed),
                 .direction = below(2) == 0 ? sim::Direction::clockwise : sim::Direction::counter_clockwise});
    bench_.run(static_cast<int>(between(20.0, 84.0) * second));
    if (!bench_.events.empty()) {
      ++false_alarms_;
      fmt::print("false alarm: {} at {:.3f} s\n", name_of(bench_.events.front().event.fault),
                 static_cast<double>(bench_.ticks) / second);
      bench_.run(3 * second);
      bench_.events.clear();
      if (!bench_.reset() || !bench_.enable()) ++broken_;
    }
  }

  void break_down(const FaultCase& c, std::size_t axis) {
    auto& count = counts_[fmt::format("{}: {}", name_of(c.fault), c.name)];
    ++count.injected;
    int since = 0;
    bench_.before_tick = [&] { c.inject(bench_, axis, since++); };
    // On a slow circle an axis needs a second or two from a turning point to where it shows.
    for (int i = 0; i < 4 * second && bench_.loop.fault(axis) == Fault::none; ++i) bench_.tick();
    const Fault fault = bench_.loop.fault(axis);
    ++(fault == c.fault ? count.seen : fault == Fault::none ? count.unseen : count.otherwise);
    bench_.run(second);
    if (bench_.powered(0) || bench_.powered(1)) ++still_powered_;
    bench_.before_tick = nullptr;
    repair(bench_, axis);
    bench_.want = Bench::Want::off;
    bench_.run(3 * second);  // to rest; frames count for a second
  }

  std::mt19937_64 random_;
  Bench bench_;
  std::vector<FaultCase> cases_;
  std::map<std::string, Count> counts_;
  double marks_, marks_at_minute_ = 0.0;  // bytes
  int false_alarms_ = 0, broken_ = 0, still_powered_ = 0;
};

int run(double minutes, std::uint64_t seed) {
  const auto machine = cross_table({"axis.*.encoder.velocity=estimated", "axis.*.encoder.noise=5 nm"});
  const auto begin = std::chrono::steady_clock::now();
  Endurance endurance(seed, machine);
  fmt::print("{:g} minutes of drive time, seed {}\n", minutes, seed);
  const bool passed = endurance.run(minutes);
  endurance.print(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return passed ? 0 : 1;
}

}  // namespace
}  // namespace stiction::test

int main(int argc, char** argv) {
  double minutes = 10.0;
  std::uint64_t seed = 1;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--minutes") minutes = std::stod(argv[i + 1]);
    if (option == "--seed") seed = std::stoull(argv[i + 1]);
  }
  return stiction::test::run(minutes, seed);
}
