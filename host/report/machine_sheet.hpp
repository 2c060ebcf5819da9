// A machine's parameters as a report prints them: in engineering units, one column an axis or the feed drive. Made from
// the tables of firmware/machine/file/parameters.hpp and of the friction models, so a new parameter appears here
// without a line.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

struct SheetRow {
  std::string label;
  std::string unit;                 // empty for names and dimensionless numbers
  std::vector<std::string> values;  // one a column; empty where the axis does not have it
};

struct SheetSection {
  std::string title;
  std::vector<std::string> columns;  // the axes, or the feed drive
  std::vector<SheetRow> rows;        // at least one value in each
};

std::vector<SheetSection> machine_sheet(const machine::Machine& machine);

// As the machine file calls them: "synchronous", "mean-difference".
std::string motor_model_name(machine::MotorModel model);
std::string velocity_source_name(machine::VelocitySource source);

}  // namespace stiction::host
