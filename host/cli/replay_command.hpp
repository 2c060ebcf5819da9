// The set-points of a log through the simulation: `stiction simulate replay` and `stiction compare LOG`.
#pragma once

#include <string>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"

namespace stiction::host {

struct ReplayOptions {
  MachineOptions machine;  // one, or a list
  std::string from;        // the log
  std::string friction;    // empty: the machine file's
  std::string axis;        // of the machine, for a log that names none
  std::string signals = "fixed";
  std::string log;  // empty: the simulated log is not kept
  std::string out;  // empty: no folder of results
  bool json = false;
};

// Replays the log on every machine with every friction model, prints, writes. Throws UsageError, LogError,
// FaultTripped.
void run_replay(const ReplayOptions& options, const Invocation& invocation);

}  // namespace stiction::host
