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

// The same with the sample rates of the logs that were read.
inline Origin report_origin(const std::string& machines, const std::vector<Log>& logs) {
  auto origin = report_origin(machines);
  for (const auto& log : logs) {
    origin.sources.push_back(log.source);
    origin.sample_periods.push_back(log.period);
  }
  return origin;
}

}  // namespace stiction::host
