// Writes the record that the tests identify from, with noise, as CSV logs: what someone can try `stiction identify` on.
// usage: write_commissioning_logs FOLDER [FRICTION MODEL]
#include <filesystem>

#include "host/log/csv_log.hpp"
#include "tests/host/identify/campaign.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  if (argc < 2) return 2;
  const std::filesystem::path folder(argv[1]);
  std::filesystem::create_directories(folder);
  const auto machine = test::bench_machine(argc > 2 ? argv[2] : "lugre");
  std::uint64_t seed = 1;
  for (const auto& trajectory : test::commissioning()) {
    auto name = trajectory.name + ".csv";
    for (char& c : name)
      if (c == ' ') c = '-';
    host::write_csv_log(folder / name, test::with_noise(test::simulated(machine, trajectory), {}, seed++));
  }
}
