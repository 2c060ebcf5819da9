// usage: batch_loop TICKS
// What tests/host/python/batch_instructions.py asks Python for, in C++: 64 axes that differ in mass follow a sine, and
// three signals of each are kept in every tick. Prints the sum of the positions of the last one.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "host/batch/batch_run.hpp"
#include "sim/machine_file.hpp"

namespace {

using namespace stiction;

constexpr std::size_t axes = 64, machines = 8;
constexpr double amplitude = 1e-3, rate = 30.0;  // m, rad/s

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: batch_loop TICKS\n");
    return 2;
  }
  const auto ticks = static_cast<std::size_t>(std::atol(argv[1]));
  std::vector<machine::Machine> all;
  for (std::size_t k = 0; k < machines; ++k)
    all.push_back(sim::read_machine(std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml",
                                    {{}, {"axis.X.mass=" + std::to_string(200 + 10 * k) + " kg"}}));
  std::vector<host::BatchRun::Member> members;
  for (std::size_t k = 0; k < axes; ++k) members.push_back({&all[k % machines], 0, 0.0});
  host::BatchRun run(members);
  std::vector<double> x(ticks * axes), e(ticks * axes), i_set(ticks * axes);
  const double period = all.front().timing.fast_period;
  for (std::size_t k = 0; k < ticks; ++k) {
    const double phase = rate * static_cast<double>(k) * period;
    const sim::AxisSetPoint point{amplitude * std::sin(phase), amplitude * rate * std::cos(phase),
                                  -amplitude * rate * rate * std::sin(phase), 0.0};
    run.tick({&point, 1});
    run.values(host::Row::x, {x.data() + k * axes, axes});
    run.values(host::Row::e, {e.data() + k * axes, axes});
    run.values(host::Row::i_set, {i_set.data() + k * axes, axes});
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < axes; ++k) sum += x[(ticks - 1) * axes + k];
  std::printf("%.17g\n", sum);
  return 0;
}
