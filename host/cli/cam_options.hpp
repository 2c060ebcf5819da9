// What the commands of `stiction cam` have in common: the motion file, one of its cams, speeds.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "host/cam/axis_load.hpp"
#include "host/cli/machine_options.hpp"
#include "host/requests/cam_choice.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

struct MotionOptions {
  std::string motion;  // file
  std::string cam;     // name; empty: the only one

  // `several`: the command serves all cams of a file.
  void add_to(CLI::App& command, bool several = false);
  // All cams of the file, or the one named. Throws machine::MachineFileError, UsageError.
  std::vector<sim::cam::Cam> cams() const;
  // The one cam. Throws UsageError where the file has several and none is named.
  sim::cam::Cam one() const;
};

// The machine of a cam, whatever controls its axes. Throws machine::MachineFileError, UsageError.
machine::Machine machine_of_cam(const MachineOptions& options);

// The machine's axis that follows `cam`: the one of --axis, or the only one of the slave's kind. Throws
// machine::MachineFileError, UsageError. `cam`: null where any kind of axis will do.
AxisLoad load_of_axis(const MachineOptions& options, const sim::cam::Cam* cam);

// The tasks of VDI 2143 that the table has laws for, "R-R" among them, sorted.
std::vector<std::string> cam_tasks();

}  // namespace stiction::host
