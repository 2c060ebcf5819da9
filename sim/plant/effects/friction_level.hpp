// Coulomb level and viscous slope of any friction model: what the mismatches change. Model B2 (parabolic) has neither
// in the file; there both begin at 0 and stand beside its root law.
#pragma once

#include "sim/model/machine.hpp"

namespace stiction::sim {

double coulomb_of(const FrictionParameters& parameters);  // N; 0 for the parabolic model of a file
double viscous_of(const FrictionParameters& parameters);  // N s/m; 0 likewise

// Of the model in use. Maxwell-slip elements keep their stiffness, their levels are scaled to the new sum; LuGre keeps
// its contact stiffness and the ratio of static friction, the linear ramp its slope below the break velocity.
void set_coulomb(Friction& friction, double coulomb);
void set_viscous(Friction& friction, double viscous);

}  // namespace stiction::sim
