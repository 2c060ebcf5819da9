// Prints what the firmware keeps of an endless axis after every way: the program under endless_oracle.py.
// usage: endless_phase_steps NUMERATOR DENOMINATOR < WAYS      counts a turn of the axis; a way in counts a line
// A line for each: whole turns, rest in parts of a count, phase in 2^-32 turns.
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include "stiction/motion/endless_phase.hpp"

int main(int argc, char** argv) {
  using stiction::EndlessPhase;
  const std::int64_t numerator = argc == 3 ? std::atoll(argv[1]) : 0, denominator = argc == 3 ? std::atoll(argv[2]) : 0;
  if (!EndlessPhase::can_keep(numerator, denominator)) return 2;
  const auto config = EndlessPhase::config(numerator, denominator);
  EndlessPhase::State state;
  for (std::int64_t way = 0; std::scanf("%" SCNd64, &way) == 1;) {
    EndlessPhase::step(config, state, way);
    std::printf("%" PRId64 " %" PRIu64 " %" PRIu32 "\n", state.turns, state.rest, EndlessPhase::phase(config, state));
  }
}
