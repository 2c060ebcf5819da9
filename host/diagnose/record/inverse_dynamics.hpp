// The force that a machine file expects for a measured motion: m a + friction(v, history), with the friction models of
// sim/plant/friction themselves driven by the measured displacement. A difference of two such forces is the regressor
// of whatever differs between the two machines.
#pragma once

#include <optional>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/identify/motion.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::host {

// N along the motion, at the log's rate. The history begins with the motion: the first reversal's way is not known.
std::vector<double> friction_along(const machine::AxisModel& axis, const Motion& motion);
std::vector<double> force_along(const machine::AxisModel& axis, const Motion& motion);  // m a + friction

// The force with `changed` less the force with `axis`, over `by`. `motion`: the one that both make.
std::vector<double> force_change(const machine::AxisModel& axis, const machine::AxisModel& changed,
                                 const Motion& motion, double by);

// Which way the contact pushes, -1 to 1: Coulomb friction without its level. Sticking lets it be anything between.
std::vector<double> contact_level(const machine::AxisModel& axis, const Motion& motion);

// Of the friction law in use.
double coulomb_of(const machine::AxisModel& axis);                       // N
double viscous_of(const machine::AxisModel& axis);                       // N s/m
std::optional<sim::Contact> contact_of(const machine::AxisModel& axis);  // none: friction follows the speed alone
machine::AxisModel with_coulomb(machine::AxisModel axis, double coulomb);
machine::AxisModel with_viscous(machine::AxisModel axis, double viscous);
// The contact drawn out to that distance, its level and the shape of its curve kept; for friction without a contact, of
// the shape that the effect presliding_hysteresis has with a curve that is exponential.
machine::AxisModel with_contact_distance(machine::AxisModel axis, double distance);

}  // namespace stiction::host
