// Judges the records of a fleet on threads, each once: what is done is kept in the folder of the results, and is done
// again only for a log, a machine file or a program that has changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/fleet/fleet_list.hpp"
#include "host/fleet/trends.hpp"
#include "host/sweep/folder_lock.hpp"

namespace stiction::host {

struct FleetSettings {
  std::string version;  // of the program
  unsigned threads = 1;
  double false_alarms = 0.005;  // of an axis in a year
  bool diagnose_alarms = true;  // a full diagnosis of each record that alarms
  bool diagnose_all = false;    // and of all others
  // After each record: how many are done of all that the present step has; `step`: "records" or "diagnoses". From any
  // thread.
  std::function<void(const std::string& step, std::size_t done, std::size_t all)> progress = {};
};

// What a full diagnosis of a record says.
struct RecordDiagnosis {
  std::vector<std::string> causes;  // effects with what each explains
  std::string message;              // why there is none; empty: there is
};

struct FleetResult {
  FleetList list;
  std::vector<machine::Machine> machines;            // of each axis
  std::vector<std::size_t> machine_axes;             // of each axis, its index in the machine
  std::vector<AxisHistory> histories;                // of each axis, its records as in FleetAxis::records
  std::map<std::size_t, RecordDiagnosis> diagnoses;  // by index in FleetList::records
  FleetTrends trends;
  std::size_t judged_before = 0;  // records whose estimates the folder had

  const machine::AxisModel& model(std::size_t axis) const { return machines[axis].axes[machine_axes[axis]]; }
};

// The place of the results, which one process works on at a time.
class FleetFolder {
 public:
  // `folder`: new, empty, or of a fleet. Throws machine::MachineFileError for one that holds anything else, and for one
  // on which a different process works.
  explicit FleetFolder(std::filesystem::path folder);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path kept() const { return folder_ / ".fleet" / "records.jsonl"; }

 private:
  std::filesystem::path folder_;
  std::vector<FolderLock> lock_;  // one
};

// Judges what is missing of `list` in `folder` as `settings` say. Throws machine::MachineFileError for a machine file
// that cannot be used and an axis that it does not have; std::runtime_error when a result cannot be kept. A record that
// cannot be judged has a message in its estimate.
FleetResult run_fleet(FleetList list, const FleetFolder& folder, const FleetSettings& settings);

}  // namespace stiction::host
