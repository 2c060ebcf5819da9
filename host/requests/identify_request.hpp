// An identification as it is asked for: of logs, or of a table of steady states, from the texts of a request.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/identification.hpp"
#include "host/log/log.hpp"

namespace stiction::host {

// The options of `stiction identify` as typed; empty: as its help says.
struct IdentifyRequest {
  std::vector<std::string> files;
  std::string columns{}, axis{}, friction{}, amperes{};
  std::vector<std::string> fix{};  // "mass=225kg"
  bool refine = false;             // in closed loop
};

// What a caller shows of it.
struct IdentifyHooks {
  std::function<std::vector<Log>(const std::vector<std::string>& files, const std::string& columns)> read;
  std::function<void()> begin = {};  // when everything is read
};

struct Identified {
  const machine::AxisModel* axis;  // of the machine
  Identification result;           // of the linear axis in its place
  std::vector<Log> logs;           // of the linear axis; none: from a table
};

// Identifies an axis of `machine`, which must outlive the result, as `request` says. `hooks`: read is there. Throws
// UsageError, LogError.
Identified identify_request(const IdentifyRequest& request, const machine::Machine& machine,
                            const IdentifyHooks& hooks);

}  // namespace stiction::host
