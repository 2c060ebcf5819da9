// Processor seconds that a diagnosis of 25 000 samples takes on one core, whole vocabulary, and what each of its parts
// takes of them; without reading files and without the page.
#include <benchmark/benchmark.h>

#include <ctime>
#include <map>
#include <string>

#include "host/diagnose/diagnose.hpp"
#include "host/simulate/commissioning.hpp"
#include "sim/machine_file.hpp"

namespace {

using namespace stiction;

constexpr std::size_t samples = 25'000;  // of the training logs, 1 kHz

// The commissioning records of the cross table's X with 3 N of ripple that its file lacks, as often as makes the
// samples: the last one cut.
host::DiagnoseInput input() {
  host::DiagnoseInput input;
  input.machine = sim::read_machine(STICTION_SOURCE_DIR "/firmware/machine/shipped/mcfv5050ln.toml",
                                    {{}, {"axis.X.encoder.velocity=estimated"}});
  auto machine = input.machine;
  machine.axes.front().effects = {{"force_ripple", {{"pitch", {0.024}}, {"cosine", {3.0}}, {"sine", {0.0}}}}};
  std::size_t missing = samples;
  for (std::uint64_t seed = 1; missing > 0; ++seed)
    for (auto& record : host::record_commissioning(machine, 0, seed)) {
      if (record.held_out) {
        if (seed == 1) input.held_out.push_back(std::move(record.log));
        continue;
      }
      auto& log = record.log;
      if (missing == 0) break;
      const std::size_t kept = std::min(missing, log.t.size());
      missing -= kept;
      log.source += std::to_string(seed);
      log.t.resize(kept);
      for (auto& axis : log.axes)
        for (const auto& channel : host::log_channels)
          if (auto& values = axis.*channel.values; !values.empty()) values.resize(kept);
      input.logs.push_back(std::move(log));
    }
  return input;
}

void diagnose(benchmark::State& state) {
  auto in = input();
  std::map<std::string, double> seconds;
  std::string part;
  std::clock_t begin = 0;
  const auto end_part = [&] {
    if (!part.empty()) seconds[part] += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  };
  in.progress = [&](std::string_view next) {
    end_part();
    part = next;
    begin = std::clock();
  };
  for (auto _ : state) {
    benchmark::DoNotOptimize(host::diagnose(in));
    end_part();
    part.clear();
  }
  for (const auto& [name, sum] : seconds)
    state.counters[name + " [s]"] = benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
}

}  // namespace

BENCHMARK(diagnose)->Unit(benchmark::kSecond)->Iterations(3);

BENCHMARK_MAIN();
