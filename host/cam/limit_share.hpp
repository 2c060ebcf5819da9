// How much of its axis' limits a motion takes, as the tuner of a cam asks for it.
#pragma once

#include <functional>

#include "host/cam/axis_load.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// Of an axis with that `load` at `master_speed`: the largest share of a limit, 1 where one is reached, for a motion and
// Coulomb friction at the motor, as a torque or a force at the output, in place of the axis' own where it is more.
std::function<double(const sim::cam::Motion& motion, double coulomb)> shares_of_limits(const AxisLoad& load,
                                                                                       double master_speed);

}  // namespace stiction::host
