// Axis-seconds per wall-second of one axis in closed loop.
#include <benchmark/benchmark.h>

#include "tests/benchmark/axis_run.hpp"

namespace {

constexpr double seconds = 2.0;

void closed_loop(benchmark::State& state, double (*run)(double)) {
  for (auto _ : state) benchmark::DoNotOptimize(run(seconds));
  state.counters["axis_seconds_per_second"] =
      benchmark::Counter(seconds, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

BENCHMARK_CAPTURE(closed_loop, fixed, stiction::benchmark::run_axis_fixed)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closed_loop, double, stiction::benchmark::run_axis_double)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
