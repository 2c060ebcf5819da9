// Friction that grows with the load, of an axis whose weight goes with its angle: whether the records show it, and its
// coefficient. Internal to this room.
#pragma once

#include "host/identify/followed_motion.hpp"
#include "host/identify/friction_fit.hpp"
#include "host/identify/instruments.hpp"

namespace stiction::host {

// Whether the friction of the rows rises with the weight: on held-out blocks the level that rises leaves less force,
// its rise is positive with 95 % certainty, and more than what no friction model gets right. `rows`: of motions with a
// level; `model`: of that level; `held`: values that are not estimated.
bool rises_with_weight(const LogRows& rows, LevelModel model, const Held& held);

// Adds load_coefficient, friction over weight, to a fit with such a level. `replicates`: of its weights.
void add_load_coefficient(FrictionFit& fit, const Eigen::MatrixXd& replicates);

}  // namespace stiction::host
