// The friction in use in a machine file: what it is like, and how it is changed, whatever its law (laws.hpp).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "firmware/machine/model/value_table.hpp"
#include "sim/plant/friction/law.hpp"

namespace stiction::sim {

// Friction of steady sliding, N, at `velocity` (m/s) with the contact pushing in `direction` (-1 to 1): see
// FrictionLaw.
using SteadyFriction = std::function<double(double velocity, double direction)>;
SteadyFriction steady_friction(const machine::FrictionParameters& friction);

// Of the law in use.
std::optional<Contact> contact_of(const machine::FrictionParameters& friction);
double coulomb_of(const machine::FrictionParameters& friction);  // N
double viscous_of(const machine::FrictionParameters& friction);  // N s/m
void set_coulomb(machine::FrictionParameters& friction, double coulomb);
void set_viscous(machine::FrictionParameters& friction, double viscous);

// The force (N) of the contact at each of these displacements (m) from rest, reached in straight steps,
// rate-independent; empty for a law without a contact.
std::vector<double> contact_force(const machine::FrictionParameters& friction,
                                  const std::vector<double>& displacements);

// The contact of the law in use drawn out by `factor`, its level kept. Does nothing for a law without a contact.
void stretch_contact(machine::FrictionParameters& friction, double factor);

// The tables of keys, for whoever opens a machine file.
std::vector<machine::ValueTable> friction_tables();

}  // namespace stiction::sim
