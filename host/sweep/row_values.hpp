// Options of a row as its command takes them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/sweep/commands.hpp"

namespace stiction::host {

// The machine of `row` as `command` runs on it, with the option compensation. Throws machine::MachineFileError.
machine::Machine machine_of(const SweepCommand& command, const SweepRow& row);

// The option `name` of `row` in `unit`; `fallback` where it has none. Throws machine::MachineFileError.
double quantity_option(const SweepRow& row, std::string_view name, const std::string& unit, double fallback);

// The option `name` of `row`, a list of quantities in `unit` separated by commas; empty where the row has none.
std::vector<double> quantity_list_option(const SweepRow& row, std::string_view name, const std::string& unit);

// The option `name` of `row`, one of `names`, the first of which it is unless given. Throws machine::MachineFileError.
std::string choice_option(const SweepRow& row, std::string_view name, const std::vector<std::string_view>& names);

// The option friction of `row`: one model that every axis of `machine` has; what the axes use where it has none. Throws
// machine::MachineFileError.
std::string friction_option(const SweepRow& row, const machine::Machine& machine);

// The axes that the option axis of `row` names: one of `machine`, or all. Throws machine::MachineFileError.
std::vector<std::size_t> axes_option(const SweepRow& row, const machine::Machine& machine);

}  // namespace stiction::host
