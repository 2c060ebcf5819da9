// Prints the impulse response of the notch, one line a tick: fixed point and double. notch_oracle.py compares them.
// usage: notch_response FREQUENCY_HZ NUMERATOR_DAMPING DENOMINATOR_DAMPING AMPLITUDE TICKS
#include <cstdio>
#include <cstdlib>

#include "tests/firmware/control/notch_fixture.hpp"

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: notch_response FREQUENCY_HZ NUMERATOR_DAMPING DENOMINATOR_DAMPING AMPLITUDE TICKS\n");
    return 2;
  }
  const stiction::machine::NotchParameters notch{std::atof(argv[1]), std::atof(argv[2]), std::atof(argv[3])};
  stiction::test::NotchFilter<stiction::FixedSignals> fixed(notch);
  stiction::test::NotchFilter<stiction::machine::DoubleSignals> real(notch);
  double x = std::atof(argv[4]);
  for (int n = std::atoi(argv[5]); n > 0; --n, x = 0.0) std::printf("%.17g %.17g\n", fixed.step(x), real.step(x));
}
