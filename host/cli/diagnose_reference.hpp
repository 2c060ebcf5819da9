// `stiction diagnose --reference circle`: causes from the machine file's own measured rows instead of from logs.
#pragma once

#include <string>

#include "host/cli/commands.hpp"
#include "host/cli/machine_options.hpp"

namespace stiction::host {

struct DiagnoseReferenceOptions {
  MachineOptions machine;
  std::string reference;  // which rows: "circle"
  std::string out;        // folder of verdict.json, extended.toml and report.html; empty: none
  bool json = false;
};

// Throws UsageError for another kind of rows or a machine without them.
void diagnose_from_reference(const DiagnoseReferenceOptions& options, const Invocation& invocation);

}  // namespace stiction::host
