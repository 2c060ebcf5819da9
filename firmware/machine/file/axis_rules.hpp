// What the tables of an axis need of one another and exclude: controller, shaft, encoders, weight.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "firmware/machine/file/document.hpp"
#include "firmware/machine/model/machine.hpp"

namespace stiction::machine {

// Whether nothing is known of the controller of an axis, and whether it has a current controller.
bool is_unknown(const AxisModel& axis);
bool has_current_loop(const AxisModel& axis);

// Refuses an `axis`, read from `table` at `path` of `document` and reduced, whose tables contradict one another; what
// several values make together is judged where none of them was refused: where the document has `errors_before` errors,
// those before the axis was read. Throws MachineFileError, or collects it.
void check_axis_rules(const Document& document, const toml::table& table, const std::string& path,
                      const AxisModel& axis, std::size_t errors_before);

// Adds the friction of the motor to that of a stiff `axis`, of which it is a part. `table` at `path` of `document`: the
// axis'. Throws MachineFileError for laws whose sum is none of the laws.
void add_motor_friction(const Document& document, const toml::table& table, const std::string& path, AxisModel& axis);

}  // namespace stiction::machine
