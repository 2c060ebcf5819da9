// It is no cause: a table stands for a smooth function that is more likely than every cause
// (host/diagnose/classes/signatures/smooth_functions.cpp).
#include "host/diagnose/classes/effect_regressor.hpp"

namespace stiction::host::effects::force_map {

extern const EffectRegressor regressor{
    .not_looked_for = "a table names no cause: it stands for a smooth force that is none of the vocabulary"};

}  // namespace stiction::host::effects::force_map
