// The options with which every command names a machine and what to run on it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/experiment/circle_result.hpp"

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

// "a,b" or "a, b": the parts without blanks around them.
std::vector<std::string> split_list(const std::string& text);

// Names of friction models: empty: what the machine file uses, each axis its own (friction_choice.hpp); "all": all that
// every axis has parameters for; or a list of them. Throws UsageError.
std::vector<std::string> friction_models(const std::string& text, const machine::Machine& machine);

// Feeds in m/s from "16 m/min" or a list of such quantities, the value of `option`. Throws UsageError.
std::vector<double> feeds(const std::string& text, const std::string& option = "--feed");

// "cw", "ccw" or "both"; "both" begins with counter-clockwise. Throws UsageError.
std::vector<sim::Direction> directions(const std::string& text);

}  // namespace stiction::host
