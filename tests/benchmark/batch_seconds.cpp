// usage: batch_seconds SECONDS [PROCESSOR_SECONDS]
// 64 axes that differ, LuGre, DC motor, plant step 15.6 us, on a circle at 16 m/min: of each instruction set that this
// processor has the instructions of an axis-second, stepped through SECONDS (0.001 is one tick of the
// position controller), and axis-seconds in a second of the processor, the best of five runs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "host/batch/batch_run.hpp"
#include "sim/experiment/circle_path.hpp"
#include "sim/machine_file.hpp"
#include "tests/benchmark/counted_instructions.hpp"

namespace {

using namespace stiction;

constexpr std::size_t axes = 64;
constexpr double settled = 0.1;  // s, that the axes run before anything is counted
constexpr int runs = 5;

// Every axis another in mass, friction and gains.
std::vector<machine::Machine> machines() {
  const auto one = sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                                     {"circle", {"axis.X.motor.model=dc", "axis.X.friction.use=lugre"}});
  std::vector<machine::Machine> all;
  for (std::size_t k = 0; k < axes; ++k) {
    auto m = one;
    m.axes.resize(1);
    const double share = static_cast<double>(k) / axes;
    m.axes[0].mass *= 0.9 + 0.2 * share;
    m.axes[0].friction.models["lugre"]["coulomb"] = {60.0 + 60.0 * share};
    m.axes[0].velocity_controller.gain *= 1.0 - 0.2 * share;
    all.push_back(std::move(m));
  }
  return all;
}

class Bench {
 public:
  Bench(std::span<const machine::Machine> all, host::InstructionSet set) : path_(settings()), run_(members(all), set) {
    advance(settled);
  }
  void advance(double seconds) {
    const double end = run_.time() + seconds - 1e-9;
    while (run_.time() < end) {
      const sim::AxisSetPoint point = path_.at(run_.time()).axes[0];
      run_.tick({&point, 1});
    }
  }

 private:
  static sim::CircleSettings settings() {
    sim::CircleSettings s;
    s.feed = 16.0 / 60.0;
    return s;
  }
  std::vector<host::BatchRun::Member> members(std::span<const machine::Machine> all) const {
    std::vector<host::BatchRun::Member> each;
    for (const auto& m : all) each.push_back({&m, 0, path_.at(0.0).axes[0].position});
    return each;
  }

  sim::CirclePath path_;
  host::BatchRun run_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: batch_seconds SECONDS [PROCESSOR_SECONDS]\n");
    return 2;
  }
  const double counted = std::atof(argv[1]), timed = argc > 2 ? std::atof(argv[2]) : 0.0;
  const auto all = machines();
  for (const auto set : host::instruction_sets()) {
    Bench bench(all, set);
    std::printf("%-8s", host::name_of(set));
    if (counted > 0.0) {
      const auto count = benchmark::counted_instructions([&] { bench.advance(counted); });
      if (count)
        std::printf(" %6.2f million instructions per axis-second",
                    static_cast<double>(*count) * 1e-6 / (counted * axes));
      else
        std::printf(" no instructions: this process may not trace others");
    }
    if (timed > 0.0) {
      double best = 0.0;
      for (int i = 0; i < runs; ++i) {
        double simulated = 0.0;
        const std::clock_t begin = std::clock();
        const auto spent = [&] { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; };
        for (; spent() < timed / runs; simulated += 0.05) bench.advance(0.05);
        best = std::max(best, simulated * axes / spent());
      }
      std::printf(" %6.0f axis-seconds per processor second", best);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  return 0;
}
