// Prints the declared aliases of an effect, one a line: a diagnosis that names one of them is as good.
#include <cstdio>

#include "sim/effects/effects.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: print_aliases EFFECT\n");
    return 2;
  }
  const auto effect = stiction::sim::find_effect(argv[1]);
  if (!effect) {
    std::fprintf(stderr, "print_aliases: found no effect '%s'\n", argv[1]);
    return 2;
  }
  for (const auto& confusion : stiction::sim::confusions_of(*effect))
    std::printf("%s\n", confusion.other.name().c_str());
  return 0;
}
