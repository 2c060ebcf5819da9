// The options with which every command names a machine and what to run on it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "sim/experiment/circle_result.hpp"

namespace stiction::host {

// What a command works on: without it, a machine is bad input.
enum class MachinePart { axes, feed_drive, any };

struct MachineOptions {
  std::string machine;           // names or paths, separated by commas where a command takes several
  std::vector<std::string> set;  // KEY=VALUE
  std::string compensation{};    // kind of friction compensation for every axis; empty: the machine file's

  void add_to(CLI::App& command, const std::string& machine_help);
  // The option --compensation, of commands that drive the axes.
  void add_compensation_to(CLI::App& command);
  // The machine, checked down to the drive's number formats. Throws sim::MachineFileError, UsageError. `name`: of a
  // shipped machine, or a path; `experiment`: whose overrides apply, or empty; `needed`: axes or a feed drive.
  machine::Machine load(const std::string& name, const std::string& experiment,
                        MachinePart needed = MachinePart::axes) const;
};

// "a,b" or "a, b": the parts without blanks around them.
std::vector<std::string> split_list(const std::string& text);

// Names of friction models: empty: the one the machine file uses; "all": all that every axis has parameters for; or a
// list of them. Throws UsageError.
std::vector<std::string> friction_models(const std::string& text, const machine::Machine& machine);

// Feeds in m/s from "16 m/min" or a list of such quantities. Throws UsageError.
std::vector<double> feeds(const std::string& text);

// "cw", "ccw" or "both"; "both" begins with counter-clockwise. Throws UsageError.
std::vector<sim::Direction> directions(const std::string& text);

}  // namespace stiction::host
