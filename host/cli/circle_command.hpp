// What the commands that run circles share: running a plan with progress, keeping the trace of a fault, the result
// folder.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/cli/commands.hpp"
#include "host/simulate/circle_plan.hpp"

namespace stiction::host {

// Where a command was told to leave things; empty: nowhere.
struct CirclePlaces {
  std::string log;        // trace of the only run
  std::string out;        // result folder
  std::string command{};  // that makes it, as in Invocation
};

// Runs the plan. When a fault trips, the run's trace is kept: in `places.log`, else as trace.csv in `places.out`, else
// as stiction-fault.csv in the current folder; then FaultTripped is thrown with the place in its text.
sim::CircleResult run_plan(const CirclePlan& plan, const CirclePlaces& places);

// Writes report.html and result.json. `folder`: new, empty or of an earlier result; `plan`, `result`: of the runs;
// `json`: result.json; `invocation`: command line and version; `machine`: as it was given on the command line.
void write_circle_folder(const std::filesystem::path& folder, const CirclePlan& plan, const sim::CircleResult& result,
                         const nlohmann::ordered_json& json, const Invocation& invocation, const std::string& machine);

}  // namespace stiction::host
