// A frequency response as it is asked for: of a simulated test or of a log, from the texts of a request.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "firmware/machine/model/machine.hpp"
#include "host/log/log.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// The options of `stiction simulate frequency-response` as typed; empty: as its help says.
struct ResponseRequest {
  std::string axis{}, loop{};
  std::string from{}, columns{};  // a log; none: the test is simulated
  std::string friction{}, signal = "multisine", speed{}, amplitude{}, lowest = "2 Hz";
  int periods = 2, passes = 8;
};

// What a caller does for it, and shows of it.
struct ResponseHooks {
  std::function<Log(const std::string& file, const std::string& columns)> read;
  std::function<void(const Log& log)> simulated = {};  // of a simulated test, before it is evaluated
};

struct Responded {
  machine::Machine machine;  // with the axes that were asked for
  sim::ExperimentResult result;
  double period = 0.0;  // s, of the log; 0: simulated
};

// The responses of axes of `machine`, of the file `file`, as `request` says. `hooks`: read is there. Throws UsageError,
// InfeasibleMotion, FaultTripped.
Responded response_request(const ResponseRequest& request, machine::Machine machine, const std::filesystem::path& file,
                           const ResponseHooks& hooks);

}  // namespace stiction::host
