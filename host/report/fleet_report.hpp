// The report page of a fleet: its axes, worst first, each with the course of its parameters as small charts: estimates
// with intervals, the trend with its band, the alarm.
#pragma once

#include <string>

#include "host/fleet/run.hpp"

namespace stiction::host {

struct FleetReport {
  std::string command;  // the command line that made it
  std::string version;  // of stiction
  const FleetResult& result;
};

// The whole page, UTF-8.
std::string fleet_report_html(const FleetReport& report);

}  // namespace stiction::host
