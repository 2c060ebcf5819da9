// A fleet as it is asked for: its records judged, and the files of the results in their folder.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "host/fleet/run.hpp"

namespace stiction::host {

// What `stiction fleet` takes; zeros as its help says.
struct FleetRequest {
  std::string list;  // file or folder
  std::string out;   // folder
  int threads = 0;   // 0: all processors
  double false_alarms = 0.005;
  bool full = false;
  bool without_diagnosis = false;
};

// What a caller says of itself, and shows of it.
struct FleetHooks {
  std::string version;            // of stiction
  std::string command_line;       // that the report shows
  std::function<void()> begin{};  // when the list is read and the folder is this process' own
  std::function<void(const std::string& step, std::size_t done, std::size_t all)> progress{};  // from any thread
};

struct FleetFound {
  FleetResult result;
  nlohmann::ordered_json document;
};

// Judges a fleet as `request` says and writes fleet.json, fleet.csv, fleet.npz and report.html into its folder. Throws
// UsageError, machine::MachineFileError; std::runtime_error when a result cannot be kept; and what `hooks` throw.
FleetFound fleet_request(const FleetRequest& request, const FleetHooks& hooks);

}  // namespace stiction::host
