// Its coefficient is a parameter of the axis, which `identify` finds of one whose weight goes with its angle.
#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::load_dependent_friction {

extern const EffectRegressor regressor{
    .not_looked_for =
        "without a weight it is a part of the mass in one direction of the acceleration; with one identify "
        "gives its coefficient"};

}  // namespace stiction::host::effects::load_dependent_friction
