#pragma once

#include <string_view>

#include "firmware/machine/model/machine.hpp"
#include "sim/effects/effect_values.hpp"

namespace stiction::sim {

// Throws EffectError in the name of `effect` on an axis whose motor and load are one body.
inline void require_shaft(std::string_view effect, const machine::AxisModel& axis) {
  if (!axis.elastic())
    throw EffectError(std::string(effect), "an axis without transmission.stiffness",
                      "one with an elastic shaft between motor and load");
}

}  // namespace stiction::sim
