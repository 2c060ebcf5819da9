// Identification of many noisy records of one simulated motion: errors against the truth, and how often intervals cover
// it.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"
#include "tests/host/identify/simulated_log.hpp"

namespace stiction::test {

// What the simulated axis has, by the names of the identified parameters; of a truth of another kind than the model,
// only what both have in common.
struct Truth {
  std::string name;
  double value;
};

struct ParameterRecord {
  std::string name;
  double truth = 0.0;
  double mean = 0.0;           // of the runs that determined it
  double largest_error = 0.0;  // |value - truth|, of these runs
  int determined = 0, covered = 0;
};

// The X axis of the cross table with the friction model `friction` acting, its other settings as the file's.
machine::Machine bench_machine(const std::string& friction);

std::vector<Truth> truths_of(const machine::AxisModel& axis);

// Simulates the commissioning record once and identifies a LuGre model from `runs` records with noise of seeds
// `first_seed` and on.
std::vector<ParameterRecord> campaign(const machine::Machine& machine, int runs, std::uint64_t first_seed);

}  // namespace stiction::test
