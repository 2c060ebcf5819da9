// Runs blind cases through the diagnosis and prints the tables; `toolchain/test --blind` calls it.
// usage: blind_campaign MACHINE CASES SEED [KIND] [--closed-loop]
//   MACHINE       the shipped cross table's file
//   KIND          all cases of one kind: null, one50, one10, one5, one2, two10, outside10, off
//   --closed-loop judge in closed loop too (slower; names are chosen without it)
// status 1: a case could not be made or judged
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "host/diagnose/diagnose.hpp"
#include "sim/machine_file.hpp"
#include "tests/blind/campaign.hpp"

int main(int argc, char** argv) {
  using namespace stiction;
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool closed_loop = std::erase(words, "--closed-loop") > 0;
  if (words.size() < 3 || words.size() > 4) {
    fmt::print(stderr, "usage: blind_campaign MACHINE CASES SEED [KIND] [--closed-loop]\n");
    return 2;
  }
  try {
    const auto shipped = sim::read_machine(words[0]);
    const auto cases = blind::plan(std::stoi(words[1]), std::stoull(words[2]), words.size() > 3 ? words[3] : "");
    const blind::Judge judge = [&](const blind::BlindCase& blind) {
      host::DiagnoseInput input;
      input.machine = blind.machine;
      input.logs = blind.training;
      input.held_out = blind.holdout;
      input.seed = blind.order.seed;
      input.closed_loop = closed_loop;
      input.next_measurement = false;
      return host::diagnose(input);
    };
    const bool terminal = isatty(fileno(stderr)) == 1;
    const auto outcomes =
        blind::run(shipped, cases, judge, static_cast<int>(std::max(1U, std::thread::hardware_concurrency())),
                   [&](std::size_t done) {
                     if (terminal) fmt::print(stderr, "\rblind: {} of {} cases", done, cases.size());
                   });
    if (terminal) fmt::print(stderr, "\n");
    fmt::print("{}", blind::report(outcomes));
    return std::any_of(outcomes.begin(), outcomes.end(), [](const auto& each) { return !each.error.empty(); }) ? 1 : 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "blind_campaign: {}\n", error.what());
    return 2;
  }
}
