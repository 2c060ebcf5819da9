// The set-points of a log through the simulation: `stiction simulate replay` and `stiction compare LOG`.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"
#include "host/simulate/replay_result.hpp"

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
  std::string columns;  // of a log without header
};

// The result as --json prints it and result.json holds it, of the measured log and its replays.
using ReplayJson = std::function<nlohmann::ordered_json(const Log& log, const std::vector<ReplayCase>& cases,
                                                        const sim::ExperimentResult& result)>;

// Replays the log on every machine with every friction model, prints, writes. `options`: of the command; `invocation`:
// for the report; `json_of`: empty: "stiction.replay/1". Throws UsageError, LogError, FaultTripped.
void run_replay(const ReplayOptions& options, const Invocation& invocation, const ReplayJson& json_of = {});

}  // namespace stiction::host
