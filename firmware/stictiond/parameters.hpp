// The parameters of a drive that an engineer may set without its machine file: the numeric keys of every axis'
// controllers, notch, feedforward, supervision and of what [drive] says of the axis, each as parameters.hpp and
// drive_parameters.hpp of firmware/machine/file describe it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/file/parameter_tables.hpp"
#include "firmware/machine/model/drive_setup.hpp"
#include "firmware/machine/model/machine.hpp"
#include "firmware/stictiond/parameter_store.hpp"

namespace stiction::drive {

struct DriveParameter {
  std::string key;  // of the machine file, "axis.X.position_controller.gain"
  std::string unit;
  std::string text;
  machine::Range range;
  bool whole = false;           // a whole number
  std::optional<double> value;  // none: left out
};

// Of every axis in the order of the machine; every axis has the same ones.
std::vector<DriveParameter> drive_parameters(const machine::Machine& machine, const machine::DriveSetup& setup);

// The set as assignments of ReadOptions::set, so that the machine file's reader checks range and sense of each. Throws
// std::runtime_error for another machine's set and for keys that are none of the parameters. `set`: as read from the
// store; `machine_id`: of the machine that is started; `parameters`: those it has.
std::vector<std::string> assignments_of(const ParameterSet& set, const std::string& machine_id,
                                        const std::vector<DriveParameter>& parameters);

}  // namespace stiction::drive
