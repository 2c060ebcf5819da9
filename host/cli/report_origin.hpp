// What a report says of its sources.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"
#include "host/cli/machine_options.hpp"
#include "host/log/log.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// `machines`: names or paths as given, separated by commas; `sources`: the files that were read. Throws
// machine::MachineFileError for a machine that is not found.
inline Origin report_origin(const std::string& machines, std::vector<std::string> sources = {}) {
  Origin origin;
  for (const auto& name : split_list(machines)) origin.machine_files.push_back(machine::find_machine(name).string());
  origin.sources = std::move(sources);
  return origin;
}

// What the logs together can determine, of each axis that they have channels of. `machine`: name or path of the file,
// whose mass and force constant the inspection compares with.
std::vector<AxisAbility> abilities_of(const std::string& machine, const std::vector<Log>& logs);

// The same with the sample rates of the logs that were read, and with what they can determine.
inline Origin report_origin(const std::string& machines, const std::vector<Log>& logs) {
  auto origin = report_origin(machines);
  origin.abilities = abilities_of(split_list(machines).front(), logs);
  for (const auto& log : logs) {
    origin.sources.push_back(log.source);
    origin.sample_periods.push_back(log.period);
  }
  return origin;
}

}  // namespace stiction::host
