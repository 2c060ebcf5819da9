// Measures the drive's table of every law at as many phases each, and prints the errors over the stroke and over the
// peaks, and how many times the proven bounds are above them. CI takes a sample (segment_table_test).
// usage: print_table_errors [PHASES]      10^7 phases a law; status 1 where an error or a bound is not as it must be
#include <fmt/format.h>

#include <cstdlib>

#include "tests/sim/cam/table_errors.hpp"

int main(int argc, char** argv) {
  using namespace stiction::sim::cam;
  const std::uint64_t phases = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  LawTable worst;
  bool holds = phases > 0;
  fmt::print("{} phases of each law\n{:<30} {:>8} {:>9} {:>9} {:>12} {:>15}\n", phases, "law", "segments", "position",
             "speed", "acceleration", "bound over it");
  const auto show = [](std::string_view name, const LawTable& t) {
    fmt::print("{:<30} {:>8} {:>9.2e} {:>9.2e} {:>12.2e} {:>7.3f} {:>7.3f}\n", name, t.segments, t.position, t.speed,
               t.acceleration, t.least_excess, t.most_excess);
    std::fflush(stdout);
  };
  for (const Law& law : laws()) {
    const LawTable t = law_table(law, phases);
    show(law.name, t);
    holds = holds && t.position <= 1e-9 && t.speed <= 1e-7 && t.acceleration <= 1e-5 && t.least_excess >= 1.0 &&
            t.most_excess <= 8.0;
    worst.segments = std::max(worst.segments, t.segments);
    worst.position = std::fmax(worst.position, t.position);
    worst.speed = std::fmax(worst.speed, t.speed);
    worst.acceleration = std::fmax(worst.acceleration, t.acceleration);
    worst.least_excess = std::fmin(worst.least_excess, t.least_excess);
    worst.most_excess = std::fmax(worst.most_excess, t.most_excess);
  }
  show("worst (wanted 1e-9, 1e-7, 1e-5)", worst);
  return holds ? 0 : 1;
}
