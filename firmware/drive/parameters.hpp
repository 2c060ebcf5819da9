// The parameters of a drive that an engineer may set without its machine file: the numeric keys of every axis'
// controllers, notch, feedforward, supervision and of what [drive] says of the axis, each as parameters.hpp and
// drive_parameters.hpp of sim/machine describe it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/drive/parameter_store.hpp"
#include "sim/machine/parameter_tables.hpp"
#include "sim/model/drive_setup.hpp"
#include "sim/model/machine.hpp"

namespace stiction::drive {

struct DriveParameter {
  std::string key;  // of the machine file, "axis.X.position_controller.gain"
  std::string unit;
  std::string text;
  sim::Range range;
  bool whole = false;           // a whole number
  std::optional<double> value;  // none: left out
};

// Of every axis in the order of the machine; every axis has the same ones.
std::vector<DriveParameter> drive_parameters(const sim::Machine& machine, const sim::DriveSetup& setup);

// The set as assignments of ReadOptions::set, so that the machine file's reader checks range and sense of each. Throws
// std::runtime_error for another machine's set and for keys that are none of the parameters. `set`: as read from the
// store; `machine_id`: of the machine that is started; `parameters`: those it has.
std::vector<std::string> assignments_of(const ParameterSet& set, const std::string& machine_id,
                                        const std::vector<DriveParameter>& parameters);

}  // namespace stiction::drive
