// The friction models of a run by one name: that of all axes, or "X lugre, Y classical" where each axis has its own.
#pragma once

#include <algorithm>
#include <string>

#include "firmware/machine/model/machine.hpp"

namespace stiction::host {

inline std::string friction_in_use(const machine::Machine& machine) {
  if (machine.axes.empty()) return {};
  const auto& first = machine.axes.front().friction.use;
  if (std::all_of(machine.axes.begin(), machine.axes.end(),
                  [&](const machine::AxisModel& axis) { return axis.friction.use == first; }))
    return first;
  std::string names;
  for (const auto& axis : machine.axes) names += (names.empty() ? "" : ", ") + axis.name + " " + axis.friction.use;
  return names;
}

// Every axis with the model `name`, which all of them have; with the name of what is in use nothing changes.
inline void use_friction(machine::Machine& machine, const std::string& name) {
  if (name == friction_in_use(machine)) return;
  for (auto& axis : machine.axes) axis.friction.use = name;
}

}  // namespace stiction::host
