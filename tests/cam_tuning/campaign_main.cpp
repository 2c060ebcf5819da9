// Tunes cams on drawn machines and prints how far each row is kept.
// usage: cam_tuning_campaign [CASES [SEED [ROW...]]]   100 cases, seed 1, all rows
// status 2: a wrong argument
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "tests/cam_tuning/campaign.hpp"

int main(int argc, char** argv) {
  using namespace stiction::cam_tuning;
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    const int cases = words.empty() ? 100 : std::stoi(words[0]);
    const std::uint64_t seed = words.size() > 1 ? std::stoull(words[1]) : 1;
    const std::vector<std::string> named(words.begin() + std::min<std::ptrdiff_t>(2, argc - 1), words.end());
    for (const auto& name : named)
      if (std::none_of(rows().begin(), rows().end(), [&](const Row& row) { return row.name == name; })) {
        fmt::print(stderr, "cam_tuning_campaign: found '{}'; expected a row:", name);
        for (const Row& row : rows()) fmt::print(stderr, " {}", row.name);
        fmt::print(stderr, "\n");
        return 2;
      }
    for (const Row& row : rows()) {
      if (!named.empty() && std::find(named.begin(), named.end(), row.name) == named.end()) continue;
      fmt::print("{}: {} (wanted {})\n  {}\n", row.name, row.about, row.wanted, row.run(seed, cases));
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "cam_tuning_campaign: {}\nusage: cam_tuning_campaign [CASES [SEED [ROW...]]]\n", error.what());
    return 2;
  }
}
