// Draws axes behind cams whose first record leaves two causes open, and prints how many of them the proposed cam
// settles.
// usage: cam_ambiguity_campaign [CASES [SEED [KIND...]]]   of each kind: 5 cases, seed 1; all kinds, else by number
// from 1 status 2: a wrong argument
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "tests/host/diagnose/cam_ambiguity.hpp"

int main(int argc, char** argv) {
  using namespace stiction::cam_ambiguity;
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    const int cases = words.empty() ? 5 : std::stoi(words[0]);
    const std::uint64_t seed = words.size() > 1 ? std::stoull(words[1]) : 1;
    for (std::size_t n = 0; n < kinds().size(); ++n) {
      const auto& kind = kinds()[n];
      if (words.size() > 2 && std::find(words.begin() + 2, words.end(), std::to_string(n + 1)) == words.end()) continue;
      int ambiguous = 0, proposed = 0, settled = 0;
      for (int k = 0; k < cases; ++k) {
        const auto outcome = run(kind, 1000 * seed + static_cast<std::uint64_t>(k));
        ambiguous += outcome.ambiguous;
        proposed += outcome.proposed;
        settled += outcome.settled;
        fmt::print("  {}\n", outcome.text);
        std::fflush(stdout);
      }
      fmt::print("{}: {} of {} cases ambiguous, a cam proposed in {}, settled by it {}\n", kind.name, ambiguous, cases,
                 proposed, settled);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "cam_ambiguity_campaign: {}\nusage: cam_ambiguity_campaign [CASES [SEED [KIND...]]]\n",
               error.what());
    return 2;
  }
}
