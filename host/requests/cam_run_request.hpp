// A cam on a simulated axis as it is asked for, from the texts of a request: the drive's electronic cam, or the models
// of a load on an elastic axis.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "host/log/log.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// The options of `stiction simulate cam` as typed; empty: as its help says.
struct CamRunRequest {
  std::string motion;         // file
  std::string name{};         // of the cam in it
  std::string speed, axis{};  // of the master; that follows
  std::string master = "ideal";
  int cycles = 3;
  std::string model{};        // of a load on an elastic axis, a list; empty: the drive's cam
  bool verification = false;  // of these models, in place of motion and speed
};

// What a caller does for it, and shows of it.
struct CamRunHooks {
  std::function<machine::Machine(const MachineNeeds& needs)> load;  // the machine with what it `needs`
  std::function<void(std::size_t runs)> begin = {};                 // before the runs of the drive's cam
  std::function<void(const std::string& label)> done = {};          // after each of them
};

struct CamRunFound {
  machine::Machine machine;  // with the axis that follows
  std::string cam;           // name
  sim::ExperimentResult result;
  struct Run {
    std::string name;  // "compensated"
    Log log;
  };
  std::vector<Run> logs{};  // of the runs that record one, in their order
};

// Runs a cam as `request` says. `hooks`: load is there. Throws UsageError, machine::MachineFileError, FaultTripped.
CamRunFound cam_run_request(const CamRunRequest& request, const CamRunHooks& hooks);

}  // namespace stiction::host
