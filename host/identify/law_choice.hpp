// Which friction law is identified of an axis unless one is named.
#pragma once

#include <string>

#include "host/identify/friction_fit.hpp"
#include "host/identify/standstill.hpp"
#include "sim/plant/friction/coulomb_viscous.hpp"
#include "sim/plant/friction/lugre.hpp"

namespace stiction::host {

// The law whose contact the logs of `axis` are fitted with, by its name in a machine file: the one in use where its
// contact has one length, else LuGre's.
inline std::string contact_law(const machine::AxisModel& axis) {
  return has_contact_of_one_length(axis.friction) ? axis.friction.use : std::string(sim::LuGre<>::name);
}

// The same, or the published recipe where `axis` sticks rigidly.
inline std::string usual_law(const machine::AxisModel& axis) {
  return sticks_rigidly(axis) ? std::string(sim::CoulombViscous<>::name) : contact_law(axis);
}

}  // namespace stiction::host
