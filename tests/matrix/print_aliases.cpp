// Prints the declared aliases of an effect, one a line: a diagnosis that names one of them is as good.
#include <cstdio>

#include "sim/effects/effects.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: print_aliases EFFECT\n");
    return 2;
  }
  const auto* kind = stiction::sim::find_effect_kind(argv[1]);
  if (kind == nullptr) {
    std::fprintf(stderr, "print_aliases: found no effect '%s'\n", argv[1]);
    return 2;
  }
  for (const auto& alias : kind->aliases)
    std::printf("%.*s\n", static_cast<int>(alias.effect.size()), alias.effect.data());
  return 0;
}
