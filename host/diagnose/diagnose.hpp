// What the simulation of an axis gets wrong: causes with parameters and evidence from measured logs, what they gain on
// held-out data, what was rejected and what stays unexplained.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/diagnose/verdict.hpp"
#include "host/log/log.hpp"
#include "sim/model/machine.hpp"

namespace stiction::host {

struct DiagnoseInput {
  sim::Machine machine;
  std::size_t axis = 0;          // of the machine
  std::vector<Log> logs;         // at least one
  std::vector<Log> held_out;     // empty: the last third of each log is held out
  std::uint64_t seed = 1;        // of the bootstrap
  bool closed_loop = true;       // replay the held-out logs where they have set-points
  bool next_measurement = true;  // propose one where something is open
  std::function<void()> progress;
};

// Throws LogError for logs that cannot be used (record_checks.hpp, suitability.hpp).
Verdict diagnose(const DiagnoseInput& input);

}  // namespace stiction::host
