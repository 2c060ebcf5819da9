// The summary of a sweep as JSON and as text, and the script of its batch job.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/sweep/results.hpp"

namespace stiction::host {

// "stiction.sweep/1": `summary` of `spec`, whose figures are those of `plan`.
nlohmann::ordered_json sweep_json(const SweepSpec& spec, const SweepPlan& plan, const SweepSummary& summary);

// That `json` text for a terminal.
std::string sweep_text(const std::string& json);

struct SlurmJob {
  std::string spec, out;
  int tasks = 1, threads = 1;
  bool yes = false;
};
// A script for sbatch: an array job whose tasks share the sweep.
std::string slurm_script(const SlurmJob& job);

}  // namespace stiction::host
