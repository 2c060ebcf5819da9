// A replay as it is asked for: the set-points of a log through one or several machines, from the texts of a request.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/log/log.hpp"
#include "host/simulate/machine_needs.hpp"
#include "host/simulate/replay_result.hpp"

namespace stiction::host {

// The options of `stiction simulate replay` as typed; empty: as its help says.
struct ReplayRequest {
  std::vector<std::string> machines;  // names or paths
  std::string from;                   // the log
  std::string columns{}, friction{}, axis{}, signals = "fixed";
};

// What a caller does for it, and shows of it.
struct ReplayHooks {
  // The machine of this name with what it `needs`.
  std::function<machine::Machine(const std::string& name, const MachineNeeds& needs)> load;
  std::function<void(std::size_t runs)> begin = {};            // before the log is read
  std::function<void(const std::string& label)> running = {};  // before each run
};

struct Replayed {
  Log log;                        // the measured one
  std::vector<ReplayCase> cases;  // each machine with each friction model
  sim::ExperimentResult result;
};

// Replays the log on every machine with every friction model, as `request` says. `hooks`: load is there. Throws
// UsageError, LogError, FaultTripped, and what the hooks throw.
Replayed replay_request(const ReplayRequest& request, const ReplayHooks& hooks);

}  // namespace stiction::host
