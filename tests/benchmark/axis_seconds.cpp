// usage: axis_seconds fixed|double SECONDS      prints the last position
// Under callgrind with --instr-atstart=no all seconds but the first are counted.
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/benchmark/axis_run.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: axis_seconds fixed|double SECONDS\n");
    return 2;
  }
  const double seconds = std::atof(argv[2]);
  const bool fixed = std::string_view(argv[1]) == "fixed";
  std::printf("%.9f\n",
              fixed ? stiction::benchmark::run_axis_fixed(seconds) : stiction::benchmark::run_axis_double(seconds));
}
