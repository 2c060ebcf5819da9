// A cam of a motion file, the speed of its master and the axis that follows it, from the texts of a request.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/cam/axis_load.hpp"
#include "host/simulate/machine_needs.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// What a machine needs whose axis a cam is held against, whatever controls it.
const MachineNeeds& cam_needs();

// All cams of the motion file `file`, or the one of that `name`, the value of `option`. Throws
// machine::MachineFileError, UsageError.
std::vector<sim::cam::Cam> cams_of(const std::string& file, const std::string& name, const std::string& option);
// The one cam of `file` and `name`; messages name `option`. Throws UsageError where the file has several and `name` is
// empty.
sim::cam::Cam one_cam(const std::string& file, const std::string& name, const std::string& option);

// The speed of a `master` of that kind from `text`, the value of `option`: "130 rpm", "0.5 m/s". Throws UsageError.
double master_speed(const std::string& option, const std::string& text, sim::cam::Coordinate master);

// A quantity in `unit` from `text`, the value of `option`; `example`: of what is expected. Throws UsageError.
double cam_quantity(const std::string& option, const std::string& text, std::string_view unit,
                    const std::string& example);

// The axis of `machine` that follows `cam`: that of the name `axis`, or where it is empty the only one of the slave's
// kind. `cam`: null where any kind of axis will do. Throws UsageError.
AxisLoad axis_of_cam(const machine::Machine& machine, const std::string& axis, const sim::cam::Cam* cam);

}  // namespace stiction::host
