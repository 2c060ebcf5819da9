// `stiction identify --reference circle`: friction from the rows of the machine file instead of from logs.
#pragma once

#include <string>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"

namespace stiction::host {

struct IdentifyReferenceOptions {
  MachineOptions machine;
  std::string reference;  // which rows: "circle"
  std::string out;        // folder of report.html, result.json and identified.toml; empty: none
  bool json = false;
};

// Throws UsageError for another kind of rows or a machine without them.
void identify_reference(const IdentifyReferenceOptions& options, const Invocation& invocation);

}  // namespace stiction::host
