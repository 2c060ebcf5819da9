// Seconds that an identification of 25 000 samples takes on one core: fits, intervals, curve, presliding elements;
// without reading the file and without the page.
#include <benchmark/benchmark.h>

#include "tests/host/identify/campaign.hpp"

namespace {

using namespace stiction;

// 25 000 samples at 1 kHz: the commissioning record with three turns more of the circle.
std::vector<host::Log> record() {
  const auto machine = test::bench_machine("lugre");
  std::vector<host::Log> logs;
  std::size_t samples = 0;
  for (const auto& trajectory : test::commissioning()) logs.push_back(test::simulated(machine, trajectory));
  for (const auto& log : logs) samples += log.t.size();
  const double missing = 1e-3 * (25000.0 - static_cast<double>(samples));
  auto more = test::circle(16.0 / 60.0, 4.0);
  more.duration = missing;
  logs.push_back(test::simulated(machine, more));
  for (std::size_t k = 0; k < logs.size(); ++k) logs[k] = test::with_noise(logs[k], {}, k + 1);
  return logs;
}

void identify(benchmark::State& state) {
  const auto logs = record();
  const auto machine = test::bench_machine("lugre");
  std::size_t samples = 0;
  for (const auto& log : logs) samples += log.t.size();
  for (auto _ : state)
    benchmark::DoNotOptimize(host::identify_logs(logs, machine.axes.front(), {"lugre", host::Amperes::amplitude, {}}));
  state.counters["samples"] = static_cast<double>(samples);
}

}  // namespace

BENCHMARK(identify)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
