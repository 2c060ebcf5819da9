// The options with which every command names a machine and what to run on it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/requests/run_options.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::host {

struct MachineOptions {
  std::string machine;           // names or paths, separated by commas where a command takes several
  std::vector<std::string> set;  // KEY=VALUE
  std::string compensation{};    // kind of friction compensation for every axis; empty: the machine file's
  std::string axis{};            // of a command that runs on one axis alone; empty: the first

  void add_to(CLI::App& command, const std::string& machine_help);
  // The option --compensation, of commands that drive the axes.
  void add_compensation_to(CLI::App& command);
  // The option --axis, of commands that run on one axis alone.
  void add_axis_to(CLI::App& command);
  // The machine `name` (shipped, or a path) as it is in `experiment`, checked down to the drive's number formats, where
  // those matter, and to what that command `needs` (machine_needs.hpp); with one axis alone where the command runs on
  // one. Throws machine::MachineFileError, UsageError.
  machine::Machine load(const std::string& name, const std::string& experiment) const;
  machine::Machine load(const std::string& name, const std::string& experiment, const MachineNeeds& needs) const;
};

// Throws UsageError "FILE: found ...; expected ..." for a `machine`, of `file`, that lacks what the command `needs`.
void require_needs(const machine::Machine& machine, const MachineNeeds& needs, const std::filesystem::path& file);

}  // namespace stiction::host
